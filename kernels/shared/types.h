// 4-byte scalars and 4-vectors with one layout in C++ and OpenCL C.
#ifndef CLVR_SHARED_TYPES_H
#define CLVR_SHARED_TYPES_H
#ifdef __cplusplus
#include <cstdint>
namespace clvr::shared {
struct alignas(16) float4 {
    float x, y, z, w;
};
struct alignas(16) int4 {
    std::int32_t x, y, z, w;
};
using uint = std::uint32_t;
} // namespace clvr::shared
#define CLVR_SHARED_BEGIN namespace clvr::shared {
#define CLVR_SHARED_END }
#define CLVR_CHECK_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), #type)
#else
#define CLVR_SHARED_BEGIN
#define CLVR_SHARED_END
#define CLVR_CHECK_SIZE(type, bytes) typedef char type##_has_its_size[sizeof(type) == (bytes) ? 1 : -1]
#endif
#endif
