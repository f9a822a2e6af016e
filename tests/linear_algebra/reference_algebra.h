// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

// Decompositions for tests, as functions of matrices of any size. They are
// compiled once: where they stand in a test, every fixed size and every
// expression that they are given is compiled anew. None is the program's own.
namespace beamgyro::internal::reference {

using RealMatrix = Eigen::Ref<const Eigen::MatrixXd>;
using ComplexMatrix = Eigen::Ref<const Eigen::MatrixXcd>;

/// Returns x of A x = b, by elimination with partial pivoting.
Eigen::MatrixXd solution(const RealMatrix& A, const RealMatrix& b);
Eigen::MatrixXcd solution(const ComplexMatrix& A, const ComplexMatrix& b);

Eigen::MatrixXd inverse(const RealMatrix& A);
Eigen::MatrixXcd inverse(const ComplexMatrix& A);

/// Returns x of the least |A x - b|, by Householder's QR decomposition; A has
/// full column rank.
Eigen::VectorXd least_squares(const RealMatrix& A, const RealMatrix& b);

/// Returns the lower triangle L of A = L L^T, A positive definite.
Eigen::MatrixXd cholesky_root(const RealMatrix& A);

/// A v = lambda M v: values ascend, vectors are columns with v^T M v = 1.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// A is symmetric; M is symmetric and positive definite, or the identity.
SymmetricModes symmetric_modes(const RealMatrix& A, const RealMatrix& M);
SymmetricModes symmetric_modes(const RealMatrix& A);

/// Returns e^A: the Taylor series of A / 2^s, whose norm is below 1/2, squared
/// s times. Its error is about that of multiplying 2^s matrices.
Eigen::MatrixXd exponential(const RealMatrix& A);
Eigen::MatrixXcd exponential(const ComplexMatrix& A);

}  // namespace beamgyro::internal::reference
