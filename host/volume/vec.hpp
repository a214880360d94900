// Small double-precision vectors and 3x3 matrices: what the host computes for kernels is computed in double and rounded once.
#pragma once
#include <array>
#include <cmath>

namespace clvr {

using Double3 = std::array<double, 3>;
using Int3 = std::array<int, 3>;

inline constexpr double pi = 3.14159265358979323846, radian = pi / 180; ///< radian: of a degree

inline Double3 operator+(const Double3& a, const Double3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Double3 operator-(const Double3& a, const Double3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Double3 operator*(const Double3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double inner(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Double3& a) { return std::sqrt(inner(a, a)); }
inline double lerp(double a, double b, double t) { return std::fma(t, b - a, a); }
inline Double3 lerp(const Double3& a, const Double3& b, double t) {
    return {lerp(a[0], b[0], t), lerp(a[1], b[1], t), lerp(a[2], b[2], t)};
}
inline Double3 unit(const Double3& a) { return a * (1.0 / norm(a)); }

/// Row-major 3x3 matrix.
struct Matrix3 {
    std::array<Double3, 3> row{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Double3 operator*(const Double3& v) const { return {inner(row[0], v), inner(row[1], v), inner(row[2], v)}; }
    Double3 column(int j) const { return {row[0][j], row[1][j], row[2][j]}; }
    Matrix3 transposed() const { return {{{column(0), column(1), column(2)}}}; }
    double determinant() const { return inner(row[0], cross(row[1], row[2])); }
    /// The inverse; the caller has made sure that the determinant is not 0.
    Matrix3 inverse() const {
        const double s = 1.0 / determinant();
        return Matrix3{{{cross(row[1], row[2]) * s, cross(row[2], row[0]) * s, cross(row[0], row[1]) * s}}}.transposed();
    }
};

} // namespace clvr
