// Rules of integration over 0..1.
#pragma once
#include <cmath>
#include <vector>

namespace clvr::reference {

struct Node {
    double at, weight;
};
using Quadrature = std::vector<Node>;

/// For integrands with kinks.
inline Quadrature midpoints(int n) {
    Quadrature q;
    for (int k = 0; k < n; ++k) q.push_back({(k + 0.5) / n, 1.0 / n});
    return q;
}

/// Gauss-Legendre, for smooth ones: exact for polynomials of degree 2n - 1. The zeros of the Legendre polynomial by Newton's method.
inline Quadrature gauss(int n) {
    Quadrature q;
    for (int k = 0; k < n; ++k) {
        double x = std::cos(3.14159265358979323846 * (k + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 20; ++step) {
            double value = x, before = 1;
            for (int j = 2; j <= n; ++j) {
                const double next = ((2 * j - 1) * x * value - (j - 1) * before) / j;
                before = value;
                value = next;
            }
            slope = n * (x * value - before) / (x * x - 1);
            x -= value / slope;
        }
        q.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
    }
    return q;
}

} // namespace clvr::reference
