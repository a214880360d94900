#include "host/frame/film.hpp"
#include "runtime/schedule/scheduler.hpp"

namespace clvr {

bool Film::is_on(const Device& device) const { return is_same(device_, device); }

int Film::require(const std::vector<std::string>& names) {
    const int first = find(names.front());
    if (first >= 0) {
        for (std::size_t k = 0; k < names.size(); ++k)
            if (find(names[k]) != first + static_cast<int>(k))
                throw Error(ErrorKind::internal, "the plane " + names[k] + " does not follow " + names.front(), "Film");
        return first;
    }
    for (const std::string& name : names)
        if (find(name) >= 0) throw Error(ErrorKind::internal, "there is a plane " + name + " and none " + names.front(), "Film");
    const std::size_t plane_bytes = pixels() * sizeof(float), had = names_.size();
    names_.insert(names_.end(), names.begin(), names.end());
    if (names_.size() > room_ || !planes_) {
        room_ = std::max(room_, (names_.size() + 7) / 8 * 8);
        Buffer grown = device_.buffer(room_ * plane_bytes, "film");
        if (had > 0) {
            copy(device_, planes_, grown, had * plane_bytes, 0, 0);
            device_.finish(); // before the old ones go
        }
        planes_ = std::move(grown);
    }
    return static_cast<int>(had);
}

std::size_t Film::offset(const std::string& name) const {
    const int plane = find(name);
    if (plane < 0) throw Error(ErrorKind::internal, "there is no plane " + name, "Film");
    return static_cast<std::size_t>(plane) * pixels();
}

std::vector<float> Film::download(const std::string& name) { return device_.download<float>(planes_, pixels(), offset(name)); }

void Film::upload(const std::string& name, const std::vector<float>& values) {
    device_.write(planes_, values.data(), pixels() * sizeof(float), offset(name) * sizeof(float));
}

} // namespace clvr
