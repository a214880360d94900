// A browser's side of a live view's socket, without the browser: scenes go, pictures come and are acknowledged.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

namespace clvr::bench {

/// The header of a picture, and when it came.
struct ViewPicture {
    std::uint32_t number = 0;
    std::uint64_t generation = 0;
    int samples = 0, width = 0, full_width = 0, divider = 1, phase = 0; ///< phase: as clvr::Phase
    std::size_t bytes = 0;
    double at = 0; ///< steady_seconds()
};

class ViewClient {
public:
    /// Of a server at the loopback address; asks for control. Throws Error.
    ViewClient(int port, const std::string& token);
    ~ViewClient();

    /// The page's form of a scene. Returns its generation.
    std::uint64_t send_scene(const std::string& scene);
    /// The next one. Throws Error when none comes within a minute, or the server refuses something.
    ViewPicture next_picture();

private:
    class Socket;
    std::unique_ptr<Socket> socket_;
    std::uint64_t generation_ = 0;
};

} // namespace clvr::bench
