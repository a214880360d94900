#include "host/view/words.hpp"
#include "runtime/error.hpp"

#include <new>

namespace clvr::view {

std::string words_of_exception() {
    try {
        throw;
    } catch (const Error& e) {
        return e.line();
    } catch (const std::bad_alloc&) {
        return "there is no memory left on this machine";
    } catch (const std::exception& e) {
        return e.what();
    } catch (...) {
        return "something unknown went wrong";
    }
}

} // namespace clvr::view
