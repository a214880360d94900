#include "runtime/system/host_memory.hpp"

#include <fstream>
#include <string>
#include <unistd.h>

namespace clvr {

std::size_t available_memory() {
    std::ifstream meminfo("/proc/meminfo");
    std::string key, unit;
    std::size_t kib = 0;
    while (meminfo >> key >> kib) {
        if (key == "MemAvailable:") return kib << 10;
        std::getline(meminfo, unit);
    }
    return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGE_SIZE));
}

} // namespace clvr
