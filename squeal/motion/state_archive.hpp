#pragma once

#include <Eigen/Core>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace chladni::squeal {

/// Takes the state of an object bit by bit, and gives it back to an object that was made in the
/// same way: each class names its members once, in a function `exchange`, for both directions. A
/// matrix that is not empty before it is given back keeps its size.
class StateArchive {
 public:
  /// Takes.
  StateArchive() = default;
  /// Gives back.
  explicit StateArchive(std::vector<std::int64_t> words) : words_(std::move(words)), gives_(true) {}

  bool gives() const { return gives_; }
  const std::vector<std::int64_t>& words() const { return words_; }
  /// @throws chladni::Error unless all was given back that was taken.
  void expect_end() const;

  template <class... Members>
  void operator()(Members&... members)
  {
    (one(members), ...);
  }

 private:
  void one(std::int64_t& x);
  void one(double& x);

  template <std::integral Integer>
  void one(Integer& x)
  {
    auto word = static_cast<std::int64_t>(x);
    one(word);
    x = static_cast<Integer>(word);
  }

  [[noreturn]] static void misfit();

  /// Of the size that is taken, at most what the words that are left can hold.
  std::size_t size(std::size_t now);

  template <class Scalar, int rows, int cols, int options, int max_rows, int max_cols>
  void one(Eigen::Matrix<Scalar, rows, cols, options, max_rows, max_cols>& x)
  {
    const std::size_t n_rows = size(static_cast<std::size_t>(x.rows()));
    const std::size_t n_cols = size(static_cast<std::size_t>(x.cols()));
    if (size(n_rows * n_cols) != n_rows * n_cols) misfit();
    const auto n = static_cast<Eigen::Index>(n_rows), m = static_cast<Eigen::Index>(n_cols);
    if (x.size() > 0 && (x.rows() != n || x.cols() != m)) misfit();
    x.resize(n, m);
    for (Eigen::Index i = 0; i < x.size(); ++i) one(x.data()[i]);
  }

  template <class Value>
  void one(std::vector<Value>& x)
  {
    x.resize(size(x.size()));
    for (Value& value : x) one(value);
  }

  template <class Value>
  void one(std::optional<Value>& x)
  {
    bool has = x.has_value();
    one(has);
    if (!has) return x.reset();
    if (!x) x.emplace();
    one(*x);
  }

  template <class Object>
  requires requires(Object& object, StateArchive& archive) { object.exchange(archive); }
  void one(Object& object) { object.exchange(*this); }

  std::vector<std::int64_t> words_;
  std::size_t next_ = 0;
  bool gives_ = false;
};

}  // namespace chladni::squeal
