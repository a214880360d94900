#include "host/live/caught.hpp"

#include <new>

namespace clvr {

Error caught_error() {
    try {
        throw;
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        return Error(ErrorKind::host_memory, "there is no memory left on this machine");
    } catch (const std::exception& error) {
        return Error(ErrorKind::internal, error.what());
    } catch (...) {
        return Error(ErrorKind::internal, "something unknown went wrong");
    }
}

} // namespace clvr
