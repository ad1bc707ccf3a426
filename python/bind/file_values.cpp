#include "python/bind/file_values.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "files/hdf5.hpp"
#include "files/hdf5_contents.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "mbs_export/responses/response_file.hpp"
#include "python/bind/text.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/results/result_file.hpp"

namespace chladni::python {
namespace {

namespace py = pybind11;
using files::Item;

/// [rows x cols] as numpy stores it.
template <class Matrix>
py::array_t<typename Matrix::Scalar> by_rows(const Matrix& A)
{
  py::array_t<typename Matrix::Scalar> array({A.rows(), A.cols()});
  auto entries = array.template mutable_unchecked<2>();
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j) entries(i, j) = A(i, j);
  return array;
}

py::object reals(const files::Reader& file, const Item& item)
{
  if (item.rank == 0) return py::float_(file.real(item.name));
  if (item.rank == 2) return by_rows(file.matrix(item.name));
  const Eigen::VectorXd x = file.vector(item.name);
  return py::array_t<double>(x.size(), x.data());
}

py::object integers(const files::Reader& file, const Item& item)
{
  if (item.rank == 0) return py::int_(file.integer(item.name));
  if (item.rank == 2) return by_rows(file.integer_matrix(item.name));
  const std::vector<std::int64_t> x = file.integers(item.name);
  return py::array_t<std::int64_t>(py::ssize_t(x.size()), x.data());
}

py::object texts(const files::Reader& file, const Item& item)
{
  py::list list;
  for (const std::string& text : file.texts(item.name)) list.append(text_of(text));
  return list;
}

py::object value_of(const files::Reader& file, const Item& item)
{
  switch (item.kind) {
    case Item::Kind::reals:
      return reals(file, item);
    case Item::Kind::integers:
      return integers(file, item);
    default:
      return item.rank == 0 ? py::object(text_of(file.text(item.name))) : texts(file, item);
  }
}

/// The reader of the format checks what its values say of each other.
void check(const files::Reader& file, const std::string& format)
{
  if (format == mbs_export::body_format)
    mbs_export::read_body(file);
  else if (format == mbs_export::reduced_format)
    mbs_export::read_reduced(file);
  else if (format == mbs_export::response_format)
    mbs_export::read_responses(file);
  else if (format == squeal::results_format)
    squeal::read_results(file);
  else if (format == "chladni-radiation")
    squeal::read_radiation(file);
  else if (format != "chladni-sound")
    file.fail("/", fmt::format("has format '{}', which is none of Chladni's", format));
}

bool is_of_vtk(const Item& item)
{
  return item.name.starts_with("VTKHDF/");
}

}  // namespace

py::tuple file_values(const std::string& path)
{
  const files::Reader file(path);
  const std::string format = file.text_attribute("/", "format");
  check(file, format);
  py::list values;
  for (const Item& item : files::contents(file))
    if (!is_of_vtk(item))
      values.append(py::make_tuple(text_of(item.name), text_of(item.unit), value_of(file, item)));
  return py::make_tuple(text_of(format), values);
}

}  // namespace chladni::python
