// What computed volumes are made of, and how their parts are written down. No libm but sqrt, so the tables are the same everywhere.
#pragma once
#include "host/volume/vec.hpp"
#include "host/volume/voxels.hpp"
#include "kernels/shared/phantom.h"
#include "runtime/system/split_mix.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace clvr {

/// Parts that are joined and cut in order; its distance is kept within +-far [mm], as far as the kernel looks at it. Mirrored: x and -x.
struct MadeBody {
    float far = 1;
    bool mirrored = false;
    std::vector<shared::PhantomPart> parts;
};

/// A volume that clvr computes: kernels/volume/<kernel>.cl paints the bodies, in the order of that kernel's enum in shared/phantom.h. The
/// first is the outline of all.
struct MadeVolume {
    std::string kernel;
    Double3 box_low, box_size; ///< [mm]
    Int3 dims;                 ///< by default
    VoxelType type;            ///< by default
    std::vector<MadeBody> bodies;
    bool opened = false; ///< the head's window
};

/// The volumes (phantom_head.cpp and so on). Seeds change how things grow.
MadeVolume head_volume(bool opened);
MadeVolume snake_volume(std::uint64_t seed);
MadeVolume beetle_volume(std::uint64_t seed);
MadeVolume vessel_volume(std::uint64_t seed);
MadeVolume foam_volume();
MadeVolume cloud_volume(std::uint64_t seed);
MadeVolume rock_volume();
MadeVolume fibres_volume(std::uint64_t seed);
MadeVolume skull_volume(std::uint64_t seed);
MadeVolume machine_volume(std::uint64_t seed);

/// Numbers 0..1, the same everywhere.
class Chance {
public:
    explicit Chance(std::uint64_t seed) : numbers_(seed) {}
    double operator()() { return numbers_.uniform(); }
    double between(double low, double high) { return low + (high - low) * (*this)(); }
    /// Uniform on the unit sphere.
    Double3 direction() {
        for (;;) {
            const Double3 d{between(-1, 1), between(-1, 1), between(-1, 1)};
            if (const double n = norm(d); n > 0.1 && n < 1) return d * (1 / n);
        }
    }

private:
    SplitMix64 numbers_;
};

/// A point of a tube's path and the tube's radius there.
struct Node {
    double x, y, z, radius;
};

inline Double3 place(const Node& n) { return {n.x, n.y, n.z}; }
inline shared::float4 packed(const Double3& v, double w) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(w)};
}

/// The direction (0, c, s) of a line that rises by `slope` per unit.
inline Double3 rising(double slope) { return unit({0, 1, slope}); }

/// (cosine, sine, 0) of an angle in turns, by Taylor's series: double's precision without libm.
inline Double3 on_circle(double turns) {
    const int quarters = static_cast<int>(turns * 4 + (turns < 0 ? -0.5 : 0.5));
    const double angle = (turns - quarters * 0.25) * 6.283185307179586; // within an eighth of a turn
    double c = 0, s = 0, term = 1;
    for (int k = 0; k < 20; ++k) { // the k-th derivative's share
        (k % 2 ? s : c) += k / 2 % 2 ? -term : term;
        term *= angle / (k + 1);
    }
    const int q = quarters & 3;
    return q == 0 ? Double3{c, s, 0} : q == 1 ? Double3{-s, c, 0} : q == 2 ? Double3{-c, -s, 0} : Double3{s, -c, 0};
}

/// Where a part is and how it is turned: its first two axes, of unit length; the third is their cross product.
struct Pose {
    Double3 at, x{1, 0, 0}, y{0, 1, 0};
};
/// With the third axis along `axis`.
inline Pose facing(const Double3& at, const Double3& axis) {
    const Double3 x = unit(cross(axis, axis[2] * axis[2] < 0.5 * inner(axis, axis) ? Double3{0, 0, 1} : Double3{1, 0, 0}));
    return {at, x, unit(cross(axis, x))};
}

/// Appends parts to one body.
class SolidBody {
public:
    explicit SolidBody(MadeBody& body) : parts_(body.parts), far_(body.far) {}

    /// Semi-axes r around c; the solid is tilted so that its y axis rises by `slope`, and turned outwards so that its x axis moves back by
    /// `turn` per unit.
    SolidBody& ellipsoid(const Double3& c, const Double3& r, double blend, double slope = 0, double turn = 0) {
        return solid(CLVR_PART_ELLIPSOID, 1, c, r, blend, slope, turn);
    }
    /// Soft, for a body that is a sum of densities.
    SolidBody& blob(const Double3& c, const Double3& r, double density, double slope, double turn) {
        solid(CLVR_PART_ELLIPSOID, 1, c, r, 1, slope, turn);
        parts_.back().sign = static_cast<float>(density);
        return *this;
    }
    SolidBody& block(const Double3& c, const Double3& r, double blend, double slope = 0, double turn = 0) {
        return solid(CLVR_PART_BLOCK, 1, c, r, blend, slope, turn);
    }
    SolidBody& cut(const Double3& c, const Double3& r, double blend, double slope = 0, double turn = 0) {
        return solid(CLVR_PART_ELLIPSOID, -1, c, r, blend, slope, turn);
    }
    /// Half sizes and the radius of the edges [mm]; sign -1 cuts.
    SolidBody& box(const Pose& pose, const Double3& half, double edge, double blend, int sign = 1) {
        return machined(CLVR_PART_BOX, pose, half, edge, 0, norm(half), blend, sign);
    }
    /// Around the pose's third axis; a pitch [mm] makes it a screw, or a tapped hole where it cuts.
    SolidBody& cylinder(const Pose& pose, double radius, double half_length, double edge, double blend, int sign = 1, double pitch = 0) {
        return machined(CLVR_PART_CYLINDER, pose, {radius, radius, half_length}, edge, pitch, norm({radius, half_length, 0}), blend, sign);
    }
    /// Straight pieces from node to node.
    SolidBody& tube(const std::vector<Node>& nodes, double blend, int sign = 1) {
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) segment(nodes[i], nodes[i + 1], blend, sign);
        return *this;
    }
    /// A smooth curve through the nodes (Catmull-Rom), `pieces` straight pieces between two of them.
    SolidBody& curve(const std::vector<Node>& nodes, double blend, int pieces = 4, int sign = 1) {
        const int last = static_cast<int>(nodes.size()) - 1;
        Node from = nodes[0];
        for (int i = 0; i < last; ++i)
            for (int k = 1; k <= pieces; ++k) {
                const double t = static_cast<double>(k) / pieces;
                const Double3 p0 = place(nodes[std::max(i - 1, 0)]), p1 = place(nodes[i]), p2 = place(nodes[i + 1]),
                              p3 = place(nodes[std::min(i + 2, last)]);
                const Double3 p =
                    (p1 * 2 + (p2 - p0) * t + (p0 * 2 - p1 * 5 + p2 * 4 - p3) * (t * t) + (p1 * 3 - p0 - p2 * 3 + p3) * (t * t * t)) * 0.5;
                const Node to{p[0], p[1], p[2], nodes[i].radius + t * (nodes[i + 1].radius - nodes[i].radius)};
                segment(from, to, blend, sign);
                from = to;
            }
        return *this;
    }
    /// A curve and its mirror image, for bodies that are not mirrored.
    SolidBody& curves(std::vector<Node> nodes, double blend, int pieces = 4) {
        curve(nodes, blend, pieces);
        for (Node& n : nodes) n.x = -n.x;
        return curve(nodes, blend, pieces);
    }

private:
    SolidBody& solid(int kind, int sign, const Double3& c, const Double3& r, double blend, double slope, double turn) {
        const Double3 y_tilted = rising(slope), z_tilted = cross({1, 0, 0}, y_tilted);
        const Double3 along = unit({1, turn, 0}); // new x axis; the others follow the turn about z
        const auto turned = [&](const Double3& v) {
            return Double3{along[0] * v[0] - along[1] * v[1], along[1] * v[0] + along[0] * v[1], v[2]};
        };
        shared::PhantomPart p{};
        p.kind = kind;
        p.a = packed(turned({1, 0, 0}) * (1 / r[0]), 1 / r[0]);
        p.b = packed(turned(y_tilted) * (1 / r[1]), 1 / r[1]);
        p.c = packed(turned(z_tilted) * (1 / r[2]), 1 / r[2]);
        const double bound = kind == CLVR_PART_BLOCK ? norm(r) : std::max({r[0], r[1], r[2]});
        return add(p, c, bound, blend, sign);
    }
    SolidBody& machined(int kind, const Pose& pose, const Double3& half, double edge, double pitch, double bound, double blend, int sign) {
        shared::PhantomPart p{};
        p.kind = kind;
        p.a = packed(pose.x, half[0]);
        p.b = packed(pose.y, half[1]);
        p.c = packed({half[2], edge, pitch > 0 ? 1 / pitch : 0}, pitch);
        return add(p, pose.at, bound, blend, sign);
    }
    SolidBody& segment(const Node& from, const Node& to, double blend, int sign) {
        const Double3 axis = place(to) - place(from);
        shared::PhantomPart p{};
        p.kind = CLVR_PART_TUBE;
        p.a = packed(place(from), from.radius);
        p.b = packed(axis, 1 / inner(axis, axis));
        p.c = packed({to.radius - from.radius, 0, 0}, 0);
        return add(p, (place(from) + place(to)) * 0.5, norm(axis) / 2 + std::max(from.radius, to.radius), blend, sign);
    }
    SolidBody& add(shared::PhantomPart p, const Double3& c, double bound, double blend, int sign) {
        p.center = packed(c, bound + far_ + blend);
        p.blend = static_cast<float>(blend);
        p.quarter = static_cast<float>(0.25 / blend);
        p.sign = static_cast<float>(sign);
        parts_.push_back(p);
        return *this;
    }
    std::vector<shared::PhantomPart>& parts_;
    double far_;
};

} // namespace clvr
