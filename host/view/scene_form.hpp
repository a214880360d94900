// Scenes as they go between the page and the server: without the volume's file, with handles for images.
#pragma once
#include "host/render/scene.hpp"

#include <string>
#include <vector>

namespace clvr::view {

/// The scene with as large a picture and as many samples as a viewer shows; `notes` say what was changed.
Scene within_limits(Scene scene, std::vector<std::string>& notes);

/// Volume and reading are the server's, whatever a client says; a client names no file but an image by the handle that it was given.
class SceneForm {
public:
    /// `first`: the scene that the viewer begins with; its image has the handle "scene".
    explicit SceneForm(const Scene& first);

    /// What a page sends. Throws Error{input}: not a scene, members that are the server's, an image that is not there, too large.
    Scene from_page(const std::string& json) const;
    /// A saved scene file, for another volume too: `notes` say what was left out. Its image is found by the name of its file.
    Scene from_file(const std::string& text, std::vector<std::string>& notes) const;
    /// What a page is sent: one JSON object.
    std::string to_page(const Scene& scene) const;
    /// The text of a scene file for somebody else: images and the volume by their names, without folders.
    std::string to_file(const Scene& scene) const;

    /// Another time step.
    void set_frame(int frame) { volume_.reading.frame = frame, volume_.volume_sha256.clear(); }
    /// How the user calls the scene's image.
    std::string image_name(const Scene& scene) const;
    /// A file that lies at `path` and that the user calls `name`. Returns its handle.
    std::string add_image(const std::string& path, const std::string& name);
    /// Forgets the oldest uploads but so many, and not that of `kept`; returns their paths.
    std::vector<std::string> drop_images(std::size_t most, const Scene& kept);

private:
    struct Image {
        std::string handle, path, name;
    };
    Scene volume_; ///< of which only volume and reading count
    std::vector<Image> images_;
    int uploads_ = 0;

    Scene checked(Scene scene) const;
};

} // namespace clvr::view
