// How much memory of a device clvr holds. Drivers do not say: PoCL grants ten times what there is (runtime/README.md, "Quirks").
#pragma once
#include <cstddef>
#include <memory>
#include <mutex>

namespace clvr {

/// Bytes of one root device, shared by everything opened on it or on its sub-devices in this process.
class Account {
public:
    /// Takes `bytes` if the sum stays within `limit`; false leaves the account as it was.
    bool take(std::size_t bytes, std::size_t limit);
    void give_back(std::size_t bytes);
    std::size_t used() const;
    std::size_t peak() const;

private:
    mutable std::mutex mutex_;
    std::size_t used_ = 0, peak_ = 0;
};

/// The account of the root device whose OpenCL handle is `root`; lives as long as somebody holds it.
std::shared_ptr<Account> account_of(const void* root);

} // namespace clvr
