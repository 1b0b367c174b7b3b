#include "scatter/sparse_factor.h"

#include <bandvox/core/error.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

namespace bandvox {

using SparseMatrix = Eigen::SparseMatrix<double>;

struct SparseFactor::Implementation {
    Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor;
};

namespace {

SparseMatrix lowerTriangle(const NetStencil& stencil) {
    const int rows = stencil.points()[0];
    const int columns = stencil.points()[1];
    SparseMatrix matrix(rows * columns, rows * columns);
    matrix.reserve(Eigen::VectorXi::Constant(rows * columns, 25));
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const int own = i * columns + j;
            const double* const entries = stencil.entries(static_cast<std::size_t>(own));
            for (int d = static_cast<int>(NetStencil::kEntries) / 2;
                 d < static_cast<int>(NetStencil::kEntries); ++d) {
                const int x = i + d / 7 - 3;
                const int y = j + d % 7 - 3;
                if (x >= rows || y < 0 || y >= columns) continue;
                matrix.insert(x * columns + y, own) = entries[d];
            }
        }
    }
    matrix.makeCompressed();
    return matrix;
}

}  // namespace

SparseFactor::SparseFactor(const NetStencil& stencil)
    : mImplementation(std::make_unique<Implementation>()) {
    mImplementation->factor.compute(lowerTriangle(stencil));
    if (mImplementation->factor.info() == Eigen::Success) return;
    throw Error(ErrorKind::Runtime,
                "the matrix of a net of " + std::to_string(stencil.count()) +
                    " control points could not be factored; expected it to be positive definite");
}

SparseFactor::~SparseFactor() = default;
SparseFactor::SparseFactor(SparseFactor&&) noexcept = default;
SparseFactor& SparseFactor::operator=(SparseFactor&&) noexcept = default;

void SparseFactor::solve(std::span<const double> b, std::span<double> x) const {
    using Vector = Eigen::Map<const Eigen::VectorXd>;
    const auto size = static_cast<Eigen::Index>(b.size());
    Eigen::Map<Eigen::VectorXd>(x.data(), size) =
        mImplementation->factor.solve(Vector(b.data(), size));
}

DenseSymmetric inverseLessOne(std::span<const double> entries, std::size_t size) {
    const auto n = static_cast<Eigen::Index>(size);
    const Eigen::Map<const Eigen::MatrixXd> given(entries.data(), n, n);
    const Eigen::MatrixXd symmetric = 0.5 * (given + given.transpose());
    Eigen::MatrixXd inverse = symmetric.llt().solve(Eigen::MatrixXd::Identity(n, n));
    inverse.diagonal().array() -= 1;
    inverse = (0.5 * (inverse + inverse.transpose())).eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inverse, Eigen::EigenvaluesOnly);
    DenseSymmetric result;
    result.entries.assign(inverse.data(), inverse.data() + n * n);
    result.eigenvalues.assign(solver.eigenvalues().data(), solver.eigenvalues().data() + n);
    return result;
}

}  // namespace bandvox
