#include "linear/dense/products.hpp"

#include <gtest/gtest.h>

#include <string>

namespace chladni::linear {
namespace {

using Eigen::Dynamic, Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

template <typename Entry>
using Dense = Eigen::Matrix<Entry, Dynamic, Dynamic>;
template <typename Entry>
using InRows = Eigen::Matrix<Entry, Dynamic, Dynamic, Eigen::RowMajor>;

#if !EIGEN_VERSION_AT_LEAST(3, 4, 90)
static_assert(std::is_base_of_v<CompiledProduct<MatrixXd, MatrixXd>,
                                Eigen::internal::generic_product_impl<MatrixXd, MatrixXd>>);
#endif

/// A B by the definition.
template <typename Left, typename Right>
Dense<typename Left::Scalar> by_definition(const Left& A, const Right& B)
{
  const Dense<typename Left::Scalar> a = A, b = B;
  Dense<typename Left::Scalar> C = Dense<typename Left::Scalar>::Zero(a.rows(), b.cols());
  for (Index i = 0; i < a.rows(); ++i)
    for (Index j = 0; j < b.cols(); ++j)
      for (Index p = 0; p < a.cols(); ++p) C(i, j) += a(i, p) * b(p, j);
  return C;
}

/// Round-off of sums of as many terms between -1 and 1.
double round_off(Index n_terms)
{
  return 1e-15 * (1.0 + 4.0 * double(n_terms));
}

template <typename Target, typename Left, typename Right>
void expect_product(Target&& C, const Left& A, const Right& B, const std::string& which)
{
  using Entry = typename Left::Scalar;
  const Dense<Entry> expected = by_definition(A, B), before = C;
  const auto error = [&](const Dense<Entry>& wanted) {
    return C.size() == 0 ? 0.0 : (Dense<Entry>(C) - wanted).cwiseAbs().maxCoeff();
  };
  const double allowed = round_off(A.cols());
  C.noalias() += A * B;
  EXPECT_LE(error(before + expected), allowed) << which;
  C.noalias() -= A * B;
  EXPECT_LE(error(before), 2.0 * allowed) << which;
  C.noalias() = A * B;
  EXPECT_LE(error(expected), allowed) << which;
}

/// With factors as they stand, in rows, transposed, conjugated, parts, of any steps and scaled.
template <typename Target, typename Entry>
void expect_products(Target&& C, Index k, Entry factor, const std::string& which)
{
  const Index m = C.rows(), n = C.cols();
  const Dense<Entry> A = Dense<Entry>::Random(m, k), B = Dense<Entry>::Random(k, n);
  const Dense<Entry> A_turned = A.transpose(), B_turned = B.transpose();
  const InRows<Entry> A_rows = A, B_rows = B;
  const Dense<Entry> wide = Dense<Entry>::Random(2 * m + 3, 3 * k + 3);
  using Steps = Eigen::Stride<Dynamic, Dynamic>;
  const Eigen::Map<const Dense<Entry>, 0, Steps> A_apart(wide.data(), m, k,
                                                         Steps(wide.outerStride(), 2));
  expect_product(C, A, B, which + "A B");
  expect_product(C, A_rows, B, which + "rows");
  expect_product(C, A, B_rows, which + "by rows");
  expect_product(C, A_rows, B_turned.transpose(), which + "rows by rows");
  expect_product(C, A_turned.transpose(), B, which + "transposed");
  expect_product(C, A_turned.adjoint(), B, which + "adjoint");
  expect_product(C, A, B_turned.adjoint(), which + "by adjoint");
  expect_product(C, A_turned.adjoint(), B_turned.adjoint(), which + "adjoint by adjoint");
  expect_product(C, A.conjugate(), factor * B, which + "conjugate by scaled");
  expect_product(C, -A, B_turned.transpose() * factor, which + "negative by scaled");
  expect_product(C, wide.block(1, 2, m, k), B, which + "block");
  expect_product(C, A_apart, B, which + "of any steps");
  expect_product(C, A + A_apart, B.cwiseProduct(B), which + "expressions");
}

template <typename Entry>
void expect_products_of_all_shapes(Entry factor)
{
  std::srand(4);
  for (const Index m : {0, 1, 2, 7, 33}) {
    for (const Index n : {0, 1, 3, 30}) {
      for (const Index k : {0, 1, 2, 9, 40}) {
        const std::string shape =
            std::to_string(m) + " x " + std::to_string(k) + " x " + std::to_string(n) + ", ";
        Dense<Entry> C = Dense<Entry>::Random(m, n),
                     wide = Dense<Entry>::Random(3 * m + 2, 2 * n + 2);
        InRows<Entry> C_rows = C;
        expect_products(C, k, factor, shape);
        expect_products(C_rows, k, factor, shape + "into rows, ");
        expect_products(wide.block(1, 1, m, n), k, factor, shape + "into a block, ");
        using Steps = Eigen::Stride<Dynamic, Dynamic>;
        expect_products(
            Eigen::Map<Dense<Entry>, 0, Steps>(wide.data(), m, n, Steps(2 * wide.outerStride(), 3)),
            k, factor, shape + "into any steps, ");
      }
    }
  }
}

TEST(Product, OfDoublesIsThatOfItsDefinitionForAllShapesAndSteps)
{
  expect_products_of_all_shapes(-1.5);
}

TEST(Product, OfComplexNumbersIsThatOfItsDefinitionForAllShapesAndSteps)
{
  expect_products_of_all_shapes(std::complex<double>(0.5, -1.5));
}

/// Vectors known as such when compiled, whose entries stand apart.
template <typename Entry>
void expect_products_of_vectors()
{
  for (const Index m : {1, 5, 40}) {
    for (const Index k : {1, 4, 50}) {
      const Dense<Entry> A = Dense<Entry>::Random(m, k), X = Dense<Entry>::Random(3, k),
                         Z = Dense<Entry>::Random(3, m);
      Dense<Entry> Y = Dense<Entry>::Random(3, m), Y_turned = Y.transpose();
      expect_product(Y_turned.col(1), A, X.row(1).transpose(), "column");
      expect_product(Y.row(1).transpose(), A, X.row(1).adjoint(), "row as column");
      expect_product(Y.row(1), X.row(1), A.transpose(), "row");
      expect_product(Y.row(2), X.row(1).conjugate(), A.adjoint(), "row by adjoint");
      expect_product(Y.row(0).transpose(), A.conjugate(), X.row(2).transpose(), "conjugate");
      Eigen::Matrix<Entry, 1, 1> scalar;
      scalar.setRandom();
      const Eigen::Matrix<Entry, Dynamic, 1> z = Z.row(1).transpose();
      expect_product(scalar, Z.row(0), z, "inner");
    }
  }
}

TEST(Product, OfMatrixAndVectorIsThatOfItsDefinitionForVectorsOfAnyStep)
{
  std::srand(5);
  expect_products_of_vectors<double>();
  expect_products_of_vectors<std::complex<double>>();
}

TEST(Product, MayStandInWhatItIsAssignedTo)
{
  std::srand(6);
  MatrixXd A = MatrixXd::Random(30, 30);
  const MatrixXd expected = by_definition(A, by_definition(A, A));
  A = A * A * A;
  EXPECT_LT((A - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Product, ReplacesWhatIsNotANumber)
{
  const MatrixXd A = MatrixXd::Ones(40, 40);
  for (const Index n : {1, 3, 40}) {
    MatrixXd C = MatrixXd::Constant(40, n, std::nan(""));
    C.noalias() = A * MatrixXd::Ones(40, n);
    EXPECT_EQ(C, MatrixXd::Constant(40, n, 40.0)) << n;
    C.setConstant(std::nan(""));
    C.noalias() = MatrixXd(40, 0) * MatrixXd(0, n);
    EXPECT_EQ(C, MatrixXd::Zero(40, n)) << n;
  }
}

}  // namespace
}  // namespace chladni::linear
