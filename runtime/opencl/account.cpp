#include "runtime/opencl/account.hpp"

#include <algorithm>
#include <map>

namespace clvr {

bool Account::take(std::size_t bytes, std::size_t limit) {
    const std::lock_guard lock(mutex_);
    if (used_ > limit || bytes > limit - used_) return false;
    used_ += bytes;
    peak_ = std::max(peak_, used_);
    return true;
}

void Account::give_back(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    used_ -= bytes;
}

std::size_t Account::used() const {
    const std::lock_guard lock(mutex_);
    return used_;
}

std::size_t Account::peak() const {
    const std::lock_guard lock(mutex_);
    return peak_;
}

std::shared_ptr<Account> account_of(const void* root) {
    static std::mutex mutex;
    static std::map<const void*, std::weak_ptr<Account>> accounts;
    const std::lock_guard lock(mutex);
    std::shared_ptr<Account> account = accounts[root].lock();
    if (!account) accounts[root] = account = std::make_shared<Account>();
    return account;
}

} // namespace clvr
