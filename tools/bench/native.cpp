#include "tools/bench/native.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <thread>

namespace clvr::native {

namespace {

struct Vec {
    float x, y, z;
};
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float inner(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec of(const shared::float4& v) { return {v.x, v.y, v.z}; }
Vec rotate(const shared::float4* row, Vec v) { return {inner(of(row[0]), v), inner(of(row[1]), v), inner(of(row[2]), v)}; }

struct Random {
    std::uint32_t c[4], k[2];
    void block(std::uint32_t pixel, std::uint32_t n, std::uint32_t* out) const {
        std::uint32_t x = pixel, y = 0, z = n, w = 0, k0 = k[0], k1 = k[1];
        for (int r = 0; r < 10; ++r) {
            const std::uint64_t a = std::uint64_t{0xD2511F53u} * x, b = std::uint64_t{0xCD9E8D57u} * z;
            x = static_cast<std::uint32_t>(b >> 32) ^ y ^ k0, z = static_cast<std::uint32_t>(a >> 32) ^ w ^ k1;
            y = static_cast<std::uint32_t>(b), w = static_cast<std::uint32_t>(a);
            k0 += 0x9E3779B9u, k1 += 0xBB67AE85u;
        }
        out[0] = x, out[1] = y, out[2] = z, out[3] = w;
    }
};
float uniform(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

struct Field {
    const Inputs& in;
    const std::uint8_t* voxel;
    int nx, ny, nz;
    float first, scale;
    explicit Field(const Inputs& i)
        : in(i), voxel(i.voxels->data<std::uint8_t>()), nx(i.voxels->dims[0]), ny(i.voxels->dims[1]), nz(i.voxels->dims[2]),
          first(i.volume.box_low.w), scale(i.volume.box_high.w) {}

    float value(Vec p) const {
        const float px = std::clamp(p.x, 0.0f, nx - 1.0f), py = std::clamp(p.y, 0.0f, ny - 1.0f), pz = std::clamp(p.z, 0.0f, nz - 1.0f);
        const int x = std::min(static_cast<int>(px), nx - 2), y = std::min(static_cast<int>(py), ny - 2),
                  z = std::min(static_cast<int>(pz), nz - 2);
        const float tx = px - x, ty = py - y, tz = pz - z;
        const std::uint8_t* v = voxel + (static_cast<std::size_t>(z) * ny + y) * nx + x;
        const auto row = [&](const std::uint8_t* q) { return q[0] + tx * (q[1] - q[0]); };
        const std::size_t slice = static_cast<std::size_t>(nx) * ny;
        const float a = row(v), b = row(v + nx), c = row(v + slice), d = row(v + slice + nx);
        const float e = a + ty * (b - a), f = c + ty * (d - c);
        return e + tz * (f - e);
    }
    int entry(float stored, float& t) const {
        const float x = std::clamp((stored - first) * scale, 0.0f, 4095.0f);
        const int k = std::min(static_cast<int>(x), 4094);
        t = x - k;
        return k;
    }
    float opacity(float stored) const {
        float t;
        const int k = entry(stored, t);
        const float* o = in.table->opacity.data();
        return o[k] + t * (o[k + 1] - o[k]);
    }
    Vec color(float stored) const {
        float t;
        const float* c = in.table->color.data() + 4 * entry(stored, t);
        return {c[0] + t * (c[4] - c[0]), c[1] + t * (c[5] - c[1]), c[2] + t * (c[6] - c[2])};
    }
    Vec gradient(Vec p) const {
        const Vec g{value({p.x + 1, p.y, p.z}) - value({p.x - 1, p.y, p.z}), value({p.x, p.y + 1, p.z}) - value({p.x, p.y - 1, p.z}),
                    value({p.x, p.y, p.z + 1}) - value({p.x, p.y, p.z - 1})};
        return rotate(in.volume.to_normal, g * 0.5f);
    }
};

struct Walk {
    Vec o, d, i;
    float t, end;
    int c[3], step[3], last[3];
    float next[3], delta[3];

    Walk(const shared::VolumeParams& v, Vec origin, Vec dir_world) : o(origin) {
        d = rotate(v.to_index, dir_world);
        float* const dd[3] = {&d.x, &d.y, &d.z};
        for (float* x : dd)
            if (std::abs(*x) < 1e-18f) *x = 1e-18f;
        i = {1 / d.x, 1 / d.y, 1 / d.z};
        const float ax = (v.box_low.x - o.x) * i.x, bx = (v.box_high.x - o.x) * i.x, ay = (v.box_low.y - o.y) * i.y,
                    by = (v.box_high.y - o.y) * i.y, az = (v.box_low.z - o.z) * i.z, bz = (v.box_high.z - o.z) * i.z;
        t = std::max({std::min(ax, bx), std::min(ay, by), std::min(az, bz), 0.0f});
        end = std::min({std::max(ax, bx), std::max(ay, by), std::max(az, bz)});
        if (t < end) locate(v);
    }
    Vec at(float s) const { return o + d * s; }
    void locate(const shared::VolumeParams& v) {
        const Vec p = at(t);
        const float pos[3] = {p.x, p.y, p.z}, dir[3] = {d.x, d.y, d.z}, origin[3] = {o.x, o.y, o.z}, inverse[3] = {i.x, i.y, i.z};
        const int most[3] = {v.last.x, v.last.y, v.last.z}, cells[3] = {v.cells.x, v.cells.y, v.cells.z}, edge = 1 << v.cells.w;
        for (int a = 0; a < 3; ++a) {
            c[a] = std::min(static_cast<int>(std::clamp(pos[a], 0.0f, static_cast<float>(most[a]))), most[a] - 1) >> v.cells.w;
            step[a] = dir[a] > 0 ? 1 : -1;
            last[a] = dir[a] > 0 ? cells[a] - 1 : 0;
            next[a] = c[a] == last[a] ? 1e30f : ((c[a] + (dir[a] > 0)) * edge - origin[a]) * inverse[a];
            delta[a] = edge * std::abs(inverse[a]);
        }
    }
    void advance() { // to the next cell; t is its entry
        const int a = next[0] <= next[1] && next[0] <= next[2] ? 0 : next[1] <= next[2] ? 1 : 2;
        t = next[a];
        c[a] += step[a];
        next[a] = c[a] == last[a] ? 1e30f : next[a] + delta[a];
    }
    float exit() const { return std::min({next[0], next[1], next[2], end}); }
    int cell(const shared::VolumeParams& v) const { return (c[2] * v.cells.y + c[1]) * v.cells.x + c[0]; }
};

void camera(const shared::RenderParams& p, float x, float y, Vec& o, Vec& d) {
    const float sx = x * 2 / p.width - 1, sy = 1 - y * 2 / p.height;
    const Vec v = of(p.forward) + of(p.right) * sx + of(p.up) * sy;
    o = of(p.eye);
    d = v * (1 / std::sqrt(inner(v, v)));
}

template <class F>
void for_rows(int height, F&& row) { // two threads, rows interleaved
    std::thread odd([&] {
        for (int y = 1; y < height; y += 2) row(y);
    });
    for (int y = 0; y < height; y += 2) row(y);
    odd.join();
}

} // namespace

void delta_tracking(const Inputs& in, std::vector<float>& distance) {
    const Field field(in);
    const shared::RenderParams& p = in.render;
    distance.resize(static_cast<std::size_t>(p.width) * p.height);
    for_rows(p.height, [&](int y) {
        for (int x = 0; x < p.width; ++x) {
            const std::uint32_t pixel = y * p.width + x;
            Random random{{}, {p.key0, p.key1}};
            Vec o, d;
            camera(p, x + 0.5f, y + 0.5f, o, d);
            Walk w(in.volume, o, d);
            float hit = -1;
            std::uint32_t r[4], n = 0;
            float depth = 0;
            const auto draw = [&] {
                if (n % 2 == 0) random.block(pixel, n / 2, r);
                depth = -std::log(1 - uniform(r[n % 2 * 2]));
            };
            draw();
            while (w.t < w.end) {
                const float m = (*in.majorants)[w.cell(in.volume)], sigma = m * in.volume.extinction, next = w.exit();
                if (depth < (next - w.t) * sigma) {
                    w.t += depth / sigma;
                    const float choice = uniform(r[n % 2 * 2 + 1]);
                    if (choice * m < field.opacity(field.value(w.at(w.t)))) {
                        hit = w.t;
                        break;
                    }
                    ++n;
                    draw();
                } else {
                    depth -= (next - w.t) * sigma;
                    if (next >= w.end) break;
                    w.advance();
                }
            }
            distance[pixel] = hit;
        }
    });
}

void feature_march(const Inputs& in, std::vector<float>& planes) {
    const Field field(in);
    const shared::RenderParams& p = in.render;
    const std::size_t pixels = static_cast<std::size_t>(p.width) * p.height;
    planes.resize(10 * pixels);
    for_rows(p.height, [&](int y) {
        for (int x = 0; x < p.width; ++x) {
            Vec o, d;
            camera(p, x + 0.5f, y + 0.5f, o, d);
            Walk w(in.volume, o, d);
            const float t0 = w.t;
            Vec color{0, 0, 0}, normal{0, 0, 0};
            float weight = 0, depth_sum = 0, depth2_sum = 0, half_depth = 1, passed = 1;
            int k = 0;
            while (w.t < w.end && passed >= 1e-4f) {
                const float exit = w.exit();
                if ((*in.majorants)[w.cell(in.volume)] > 0) {
                    for (float t; (t = t0 + (k + 0.5f) * p.step) < exit && passed >= 1e-4f; ++k) {
                        const Vec q = w.at(t);
                        const float stored = field.value(q), a = 1 - std::exp(-field.opacity(stored) * in.volume.extinction * p.step);
                        if (!(a > 0)) continue;
                        const float share = passed * a, depth = (t - p.depth_near) * p.depth_scale;
                        Vec g = field.gradient(q);
                        const float length = std::sqrt(inner(g, g));
                        if (length > 0) g = g * ((inner(g, d) > 0 ? -1 : 1) / length);
                        color = color + field.color(stored) * share;
                        normal = normal + g * share;
                        weight += share, depth_sum += share * depth, depth2_sum += share * depth * depth;
                        passed -= share;
                        if (half_depth >= 1 && passed <= 0.5f) half_depth = depth;
                    }
                } else {
                    k = std::max(k, static_cast<int>(std::ceil((exit - t0) / p.step - 0.5f)));
                }
                if (exit >= w.end) break;
                w.advance();
            }
            const bool seen = weight >= 1 / 256.0f;
            const float s = seen ? 1 / weight : 0, depth = depth_sum * s;
            const float out[10] = {seen ? color.x * s : 1,
                                   seen ? color.y * s : 1,
                                   seen ? color.z * s : 1,
                                   normal.x * s,
                                   normal.y * s,
                                   normal.z * s,
                                   seen ? depth : 1,
                                   weight,
                                   seen ? std::sqrt(std::max(0.0f, depth2_sum * s - depth * depth)) : 0,
                                   seen ? half_depth : 1};
            for (int c = 0; c < 10; ++c) planes[c * pixels + static_cast<std::size_t>(y) * p.width + x] = out[c];
        }
    });
}

} // namespace clvr::native
