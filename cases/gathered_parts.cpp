#include <mpi.h>

#include <algorithm>

#include "cases/harmonic_part.hpp"
#include "cases/ranks.hpp"
#include "common/packing.hpp"
#include "common/petsc.hpp"

namespace chladni::cases {

namespace {

using Eigen::MatrixXd;

void transfer(Packer& archive, const MatrixXd& A)
{
  archive(std::int64_t{A.rows()});
  archive(std::int64_t{A.cols()});
  archive(std::vector<double>(A.data(), A.data() + A.size()));
}

void transfer(Unpacker& archive, MatrixXd& A)
{
  std::int64_t rows = 0, cols = 0;
  std::vector<double> values;
  archive(rows);
  archive(cols);
  archive(values);
  A = Eigen::Map<const MatrixXd>(values.data(), rows, cols);
}

void transfer_count(auto& archive, auto& count)
{
  archive(count.sigma);
  archive(count.expected);
  archive(count.found);
}

void transfer_certificate(auto& archive, auto& certificate)
{
  archive(certificate.lambda);
  archive(certificate.eta2);
  archive(certificate.estimates);
  archive(certificate.rounding);
  archive(certificate.bounds);
  transfer_count(archive, certificate.fixed_interface);
  transfer_count(archive, certificate.range);
  transfer_count(archive, certificate.complete);
  archive(certificate.n_zero);
  archive(certificate.zero_energy);
  archive(certificate.condition);
  archive(certificate.count_share);
  archive(certificate.responses.Omega);
  archive(certificate.responses.error);
}

void transfer_mass(auto& archive, auto& mass)
{
  transfer(archive, mass.displacement);
  transfer(archive, mass.position_displacement);
  archive.each(mass.couplings, [](auto& within, auto& coupling) {
    within(coupling.other);
    for (auto* blocks : {&coupling.of_other, &coupling.of_other_transposed})
      for (auto& block : *blocks) transfer(within, block);
  });
}

void transfer_part(auto& archive, auto& part, auto& omega)
{
  archive(part.order);
  archive(part.n_coordinates);
  archive(part.masters);
  for (auto* A : {&part.K, &part.M, &part.C, &part.H, &omega, &part.interface.x, &part.interface.y,
                  &part.picture.x, &part.picture.y, &part.sector.x, &part.sector.y,
                  &part.deviating.x, &part.deviating.y})
    transfer(archive, *A);
  transfer_mass(archive, part.mass);
  transfer_certificate(archive, part.certificate);
  archive(part.factor_entries);
  archive(part.factor_s);
  archive(part.modes_residual);
}

std::vector<char> packed(const std::vector<HarmonicPart>& parts)
{
  Packer packer;
  packer(parts.size());
  for (const HarmonicPart& part : parts) {
    const MatrixXd omega = part.omega;
    transfer_part(packer, part, omega);
  }
  return packer.bytes();
}

void unpack(const std::vector<char>& bytes, std::vector<HarmonicPart>& parts)
{
  Unpacker unpacker(bytes);
  std::size_t n = 0;
  unpacker(n);
  for (std::size_t i = 0; i < n; ++i) {
    HarmonicPart& part = parts.emplace_back();
    MatrixXd omega;
    transfer_part(unpacker, part, omega);
    part.omega = omega.reshaped();
  }
}

constexpr std::size_t piece = std::size_t(1) << 30;  // an MPI count is an int

void send(const std::vector<char>& bytes)
{
  const std::size_t size = bytes.size();
  MPI_Send(&size, sizeof(size), MPI_BYTE, 0, 0, PETSC_COMM_WORLD);
  for (std::size_t at = 0; at < size; at += piece) {
    MPI_Send(bytes.data() + at, static_cast<int>(std::min(piece, size - at)), MPI_BYTE, 0, 0,
             PETSC_COMM_WORLD);
  }
}

std::vector<char> received(int from)
{
  std::size_t size = 0;
  MPI_Recv(&size, sizeof(size), MPI_BYTE, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
  std::vector<char> bytes(size);
  for (std::size_t at = 0; at < size; at += piece) {
    MPI_Recv(bytes.data() + at, static_cast<int>(std::min(piece, size - at)), MPI_BYTE, from, 0,
             PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  return bytes;
}

}  // namespace

std::vector<HarmonicPart> gathered(std::vector<HarmonicPart> own)
{
  if (rank() > 0) {
    send(packed(own));
    return {};
  }
  std::vector<HarmonicPart> parts = std::move(own);
  for (int from = 1; from < n_ranks(); ++from) unpack(received(from), parts);
  std::ranges::sort(parts, {}, &HarmonicPart::order);
  return parts;
}

}  // namespace chladni::cases
