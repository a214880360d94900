// What is known of volumes that others publish.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

/// A manifest of datasets/manifests/.
struct Dataset {
    std::string name, title, source, licence, citation;
    std::string url;         ///< empty: not published as a single file; source says where to look
    std::uint64_t bytes = 0; ///< of the file at the URL
    std::string sha512;      ///< of the file, hexadecimal; empty: none was published
    std::array<int, 3> dims{};
    std::string type; ///< "u8", "u16", ...
    std::array<double, 3> spacing{};
    std::string transfer_function; ///< a preset; empty: from the histogram
    double azimuth = 30, elevation = 12, zoom = 1;
    std::string computed; ///< the volume of `clvr dataset make` that stands in for it; empty: none

    /// The URL's last part.
    std::string file_name() const;
};

/// Every manifest, by name. Throws Error{internal} when one is broken.
const std::vector<Dataset>& datasets();
/// Throws Error{usage} naming those that there are.
const Dataset& dataset_named(const std::string& name);
/// The dataset that a computed volume stands in for; null: none.
const Dataset* published_as(const std::string& computed);
/// Throws Error{internal}: what is missing or of another type; `where` names the file.
Dataset parse_manifest(const std::string& text, const std::string& where);

} // namespace clvr
