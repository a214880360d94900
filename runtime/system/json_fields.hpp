// JSON files read strictly: what is not understood is an error, never ignored.
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace clvr {

/// Parses JSON: one value, at most 64 levels deep, no member named twice. `where` (the file) goes into Error{input} with line and column.
nlohmann::json parse_json(const std::string& text, const std::string& where);

/// The members of one JSON object. Each getter leaves its variable as it is when the member is absent, and throws Error{input} naming file
/// and member when it has another type or range. `done()` rejects members that no getter asked for.
class JsonFields {
public:
    /// `path` is the object's place in the file, such as "camera" or "points[3]", empty for the whole; `object` must outlive the fields.
    JsonFields(const nlohmann::json& object, std::string where, std::string path = {});

    bool has(const std::string& name) const { return object_->contains(name); }
    /// The member, which must be there.
    const nlohmann::json& required(const std::string& name);
    /// The fields of a member that must be an object.
    JsonFields object(const std::string& name);

    void get(const std::string& name, double& value);
    void get(const std::string& name, int& value);
    void get(const std::string& name, std::uint64_t& value);
    void get(const std::string& name, bool& value);
    void get(const std::string& name, std::string& value);
    template <class T, std::size_t n>
    void get(const std::string& name, std::array<T, n>& values) {
        if (!has(name)) return;
        const nlohmann::json& list = required(name);
        if (!list.is_array() || list.size() != n) fail(name, "a list of " + std::to_string(n) + " numbers");
        for (std::size_t i = 0; i < n; ++i) read(name, list[i], values[i]);
    }
    /// One of several names, each with its value.
    template <class E>
    void choose(const std::string& name, E& value, const std::vector<std::pair<const char*, E>>& choices) {
        std::string found;
        if (!has(name)) return;
        get(name, found);
        std::string names;
        for (const auto& [choice, meaning] : choices) {
            if (found == choice) {
                value = meaning;
                return;
            }
            names += (names.empty() ? "one of " : ", ") + std::string(choice);
        }
        fail(name, names);
    }
    void done() const;

    /// "path.name" for messages.
    std::string place(const std::string& name) const { return path_.empty() ? name : path_ + "." + name; }
    [[noreturn]] void fail(const std::string& name, const std::string& expected) const;

private:
    const nlohmann::json* object_;
    std::string where_, path_;
    std::set<std::string> asked_;
    void read(const std::string& name, const nlohmann::json& from, double& value) const;
    void read(const std::string& name, const nlohmann::json& from, int& value) const;
};

} // namespace clvr
