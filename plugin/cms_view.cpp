// CMSView: ascii with the certificate, or the reduced file.
#include <petscviewer.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>

#include "plugin/cms_impl.hpp"
#include "plugin/guard.hpp"

using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

namespace {

/// A line; PETSc's printf would indent each part of one.
void print(PetscViewer viewer, const std::string& line)
{
  chladni::petsc::check(PetscViewerASCIIPrintf(viewer, "%s\n", line.c_str()));
}

void view_count(const CMSCount& count, const char* what, PetscViewer viewer)
{
  if (count.upto == 0.0) return;
  print(viewer, fmt::format("eigenvalues of the {} below {:.6g} Hz: {} expected (Sylvester), {} "
                            "found, {} missing{}",
                            what, count.upto, count.expected, count.found, count.missing,
                            count.missing > 0 ? ": take more modes" : ""));
}

void view_modes(const Result& result, PetscViewer viewer)
{
  constexpr std::size_t most_lines = 20;
  const chladni::reduce::Certificate& certificate = result.reduction.certificate;
  const std::size_t n = result.f_Hz.size();
  print(viewer, fmt::format("  mode    frequency, Hz   eta^2 (error of lambda){}",
                            certificate.bounds.empty() ? "" : "        bound"));
  for (std::size_t i = 0; i < std::min(n, most_lines); ++i) {
    const std::string bound =
        i < certificate.bounds.size() ? fmt::format("{:20.2e}", certificate.bounds[i]) : "";
    const std::string eta2 = i < certificate.eta2.size()
                                 ? fmt::format("{:16.2e}", certificate.eta2[i])
                                 : fmt::format("{:>16}", "-");
    print(viewer, fmt::format("{:6} {:16.8g} {}{}", i + 1, result.f_Hz[i], eta2, bound));
  }
  if (n > most_lines) print(viewer, fmt::format("  ... {} more", n - most_lines));
  if (!certificate.eta2.empty())
    print(viewer, fmt::format("  largest eta^2 {:.2e}", std::ranges::max(certificate.eta2)));
}

/// Modes beyond the number asked for belong to the last one: a frequency that a disc has twice is
/// not parted.
std::string partners(const chladni::reduce::ReduceOptions& wanted, std::size_t n_modes)
{
  const auto n_asked = static_cast<std::size_t>(wanted.modes.value_or(0));
  if (wanted.method != chladni::reduce::Method::craig_bampton || n_asked == 0 || n_modes <= n_asked)
    return "";
  return fmt::format(" ({} asked; {} more of the same frequency)", n_asked, n_modes - n_asked);
}

void view_result(const Result& result, const chladni::reduce::ReduceOptions& wanted,
                 PetscViewer viewer)
{
  const CMSQuality& quality = result.quality;
  constexpr double two_pi = 2.0 * std::numbers::pi;
  const std::vector<double>& omega = result.reduction.model.omega;
  if (!omega.empty()) {
    print(viewer, fmt::format("modes with held masters: {}{}, from {:.6g} to {:.6g} Hz",
                              omega.size(), partners(wanted, omega.size()), omega.front() / two_pi,
                              omega.back() / two_pi));
  }
  print(viewer, fmt::format("condition of K_ss (estimate): {:.2e}", quality.condition));
  print(viewer,
        quality.n_zero == 0
            ? std::string("zero-energy modes: none")
            : fmt::format("zero-energy modes: {}, largest eigenvalue over the first elastic one "
                          "{:.1e}",
                          quality.n_zero, quality.rigid_residual));
  view_count(quality.modes, "fixed interface", viewer);
  view_count(quality.model, "model", viewer);
  if (quality.complete.upto != quality.model.upto) view_count(quality.complete, "model", viewer);
  view_modes(result, viewer);
}

void view_state(CMS cms, PetscViewer viewer)
{
  const Inside& in = *cms->inside;
  if (in.set_up) {
    PetscInt n = 0;
    chladni::petsc::check(MatGetSize(in.set_up->body.K, &n, nullptr));
    print(viewer, fmt::format("rows: {}, masters: {}", n, in.set_up->body.masters.size()));
    if (in.problem) {
      const auto& coordinates = in.problem->harmonic.coordinates;
      print(viewer,
            fmt::format("harmonic {} of {} sectors{}", coordinates.order(), coordinates.count(),
                        coordinates.has_one_phase() ? "" : ": each eigenvalue twice"));
    }
  }
  if (in.result)
    view_result(*in.result, in.settings.options.basis, viewer);
  else
    print(viewer, "not solved yet");
}

PetscErrorCode view_ascii(CMS cms, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscObjectPrintClassNamePrefixType((PetscObject)cms, viewer));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(guarded((PetscObject)cms, __func__, [&] { view_state(cms, viewer); }));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode CMSView(CMS cms, PetscViewer viewer)
{
  PetscBool ascii = PETSC_FALSE;
  PetscBool hdf5 = PETSC_FALSE;
  const char* path = nullptr;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  if (!viewer) PetscCall(PetscViewerASCIIGetStdout(PetscObjectComm((PetscObject)cms), &viewer));
  PetscValidHeaderSpecific(viewer, PETSC_VIEWER_CLASSID, 2);
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERHDF5, &hdf5));
  if (ascii) PetscCall(view_ascii(cms, viewer));
  if (hdf5) {
    PetscCall(PetscViewerFileGetName(viewer, &path));
    PetscCall(CMSWrite(cms, path));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CMSViewFromOptions(CMS cms, PetscObject prefixed, const char name[])
{
  std::array<char, PETSC_MAX_PATH_LEN> text{};
  PetscBool given = PETSC_FALSE;
  const auto owner = prefixed ? prefixed : (PetscObject)cms;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(
      PetscOptionsGetString(owner->options, owner->prefix, name, text.data(), text.size(), &given));
  constexpr std::string_view hdf5 = "hdf5:";
  // Not by a viewer of PETSc, which would empty the file before the new one is complete.
  if (given && std::string_view(text.data()).starts_with(hdf5)) {
    PetscCall(CMSWrite(cms, text.data() + hdf5.size()));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscObjectViewFromOptions((PetscObject)cms, prefixed, name));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSWrite(CMS cms, const char filename[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCheck(cms->inside->result, PetscObjectComm((PetscObject)cms), PETSC_ERR_ORDER,
             "Call CMSSolve() before the reduced file is written");
  PetscCheck(filename && *filename, PetscObjectComm((PetscObject)cms), PETSC_ERR_FILE_OPEN,
             "No file name; give -cms_view hdf5:FILE");
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    Phase phase(cms, events.view, "reduced file");
    write_file(cms, filename);
    phase.done();
  }));
  PetscFunctionReturn(0);
}
