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

/// Stores the state of an object exactly, and restores it to an object that was constructed in the
/// same way. Each class lists its members once, in a function `exchange`, which serves both
/// directions. A matrix that is not empty before it is restored keeps its size.
class StateArchive {
 public:
  /// An archive that stores.
  StateArchive() = default;
  /// An archive that restores.
  /// @param words  from `words` of the storing archive
  explicit StateArchive(std::vector<std::int64_t> words) : words_(std::move(words)), gives_(true) {}

  /// Whether the archive restores.
  bool gives() const { return gives_; }
  const std::vector<std::int64_t>& words() const { return words_; }
  /// Checks that all stored words were restored.
  /// @throws chladni::Error when some are left.
  void expect_end() const;

  /// Stores or restores the members in order.
  /// @throws chladni::Error when the stored words do not fit them.
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

  /// Stores or restores a size; a restored size is limited by the number of words left.
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
