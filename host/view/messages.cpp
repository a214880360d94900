#include "host/view/messages.hpp"
#include "host/view/limits.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_fields.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace clvr::view {

namespace {

template <class E>
using Choices = std::vector<std::pair<const char*, E>>;

const Choices<Role> roles{{"control", Role::control}, {"watch", Role::watch}};
const Choices<Product> products{
    {"still", Product::still}, {"turntable", Product::turntable}, {"scene", Product::scene}, {"transfer", Product::transfer}};
const Choices<std::string> still_formats{{"png", "png"}, {"jpg", "jpg"}, {"exr", "exr"}};

template <class E>
const char* name_in(const Choices<E>& choices, E value) {
    return std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.second == value; })->first;
}

/// A member that must be there.
template <class T>
T given(JsonFields& fields, const char* name) {
    T value{};
    fields.required(name);
    fields.get(name, value);
    return value;
}

std::uint64_t counter(JsonFields& fields, const char* name) {
    const auto value = given<std::uint64_t>(fields, name);
    if (value > greatest_count) fields.fail(name, "a whole number up to 2^53 - 1");
    return value;
}

double share(JsonFields& fields, const char* name) {
    const auto value = given<double>(fields, name);
    if (!(value >= 0 && value <= 1)) fields.fail(name, "a number from 0 to 1");
    return value;
}

/// A whole number from 1 to `most`, where it is there.
void get_count(JsonFields& fields, const char* name, int most, std::optional<int>& value) {
    if (!fields.has(name)) return;
    fields.get(name, value.emplace());
    if (*value < 1 || *value > most) fields.fail(name, "a whole number from 1 to " + std::to_string(most));
}

Hello hello(JsonFields& fields) {
    Hello m;
    m.token = given<std::string>(fields, "token");
    fields.choose("role", m.role, roles);
    return m;
}

SceneChange scene_change(JsonFields& fields) {
    SceneChange m;
    m.generation = counter(fields, "generation");
    const nlohmann::json& scene = fields.required("scene");
    if (!scene.is_object()) fields.fail("scene", "an object");
    m.scene = scene.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return m;
}

Ack ack(JsonFields& fields) {
    const std::uint64_t number = counter(fields, "number");
    if (number > UINT32_MAX) fields.fail("number", "the number of a picture");
    return {static_cast<std::uint32_t>(number)};
}

Save save(JsonFields& fields) {
    Save m;
    m.id = counter(fields, "id");
    fields.required("what");
    fields.choose("what", m.what, products);
    fields.choose("format", m.format, still_formats);
    get_count(fields, "width", largest_side, m.width);
    get_count(fields, "height", largest_side, m.height);
    get_count(fields, "samples", largest_samples, m.samples);
    std::optional<int> views;
    get_count(fields, "views", largest_views, views);
    m.views = views.value_or(m.views);
    return m;
}

using Parser = ClientMessage (*)(JsonFields&);

const Choices<Parser> parsers{
    {"hello", [](JsonFields& f) -> ClientMessage { return hello(f); }},
    {"scene", [](JsonFields& f) -> ClientMessage { return scene_change(f); }},
    {"ack", [](JsonFields& f) -> ClientMessage { return ack(f); }},
    {"pause", [](JsonFields& f) -> ClientMessage { return Pause{given<bool>(f, "paused")}; }},
    {"take_control", [](JsonFields&) -> ClientMessage { return TakeControl{}; }},
    {"pick",
     [](JsonFields& f) -> ClientMessage {
         return Pick{counter(f, "id"), share(f, "x"), share(f, "y")};
     }},
    {"transfer_text",
     [](JsonFields& f) -> ClientMessage {
         return TransferText{counter(f, "id"), given<std::string>(f, "text")};
     }},
    {"scene_text",
     [](JsonFields& f) -> ClientMessage {
         return SceneText{counter(f, "id"), given<std::string>(f, "text")};
     }},
    {"time_step", [](JsonFields& f) -> ClientMessage { return TimeStep{given<int>(f, "step")}; }},
    {"save", [](JsonFields& f) -> ClientMessage { return save(f); }},
    {"cancel", [](JsonFields& f) -> ClientMessage { return Cancel{given<std::string>(f, "job")}; }},
};

} // namespace

ClientMessage parse_message(const std::string& text) {
    const nlohmann::json message = parse_json(text, "message");
    JsonFields fields(message, "message");
    Parser parser = nullptr;
    fields.required("type");
    fields.choose("type", parser, parsers);
    ClientMessage parsed = parser(fields);
    fields.done();
    return parsed;
}

const char* name_of(Role role) { return name_in(roles, role); }
const char* name_of(Product product) { return name_in(products, product); }

} // namespace clvr::view
