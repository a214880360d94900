// A picture with its channels on a device.
#pragma once
#include "host/frame/frame.hpp"
#include "runtime/opencl/device.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace clvr {

/// What Frame holds on the host, on a device: planes of float32, row 0 on top, width * height values each, named as a frame's channels. The
/// picture lies over nothing: R G B are premultiplied, without background.
class Film {
public:
    /// `room`: planes that memory is taken for at the first one; with more of them the film is copied.
    Film(const Device& device, int width, int height, std::size_t room = 8)
        : device_(device), width_(width), height_(height), room_(room) {}

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t pixels() const { return static_cast<std::size_t>(width_) * height_; }
    Device& device() { return device_; }
    bool is_on(const Device& device) const;

    /// Of the planes, in order.
    const std::vector<std::string>& names() const { return names_; }
    /// Number of the plane, -1 when there is none.
    int find(const std::string& name) const {
        const auto at = std::find(names_.begin(), names_.end(), name);
        return at == names_.end() ? -1 : static_cast<int>(at - names_.begin());
    }
    /// Number of the first of the planes `names`, which lie next to each other in this order; makes them (what they hold is undefined)
    /// behind the others where none is there. Throws Error{device_memory}; Error{internal} when they lie otherwise.
    int require(const std::vector<std::string>& names);
    /// [planes][height * width]
    Buffer& planes() { return planes_; }
    std::vector<float> download(const std::string& name);
    void upload(const std::string& name, const std::vector<float>& values);

    /// Samples per pixel of R G B; 0: unknown. Of one sample the planes variance.R/G/B hold nothing.
    int samples = 0;
    bool denoised = false; ///< R G B A went through a filter; the input is noisy.R G B A

private:
    std::size_t offset(const std::string& name) const; // of its plane [floats]
    Device device_;
    int width_, height_;
    std::vector<std::string> names_;
    std::size_t room_; // planes that fit into planes_, or will
    Buffer planes_;
};

} // namespace clvr
