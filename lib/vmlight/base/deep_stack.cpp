// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/deep_stack.h>

#include <cstddef>
#include <exception>

#include <pthread.h>

namespace vmlight {
namespace {

constexpr size_t kStack = size_t(512) << 20;

struct Call
{
    const std::function<void()>& work;
    std::exception_ptr thrown;
};

void* make(void* data)
{
    Call& call = *static_cast<Call*>(data);
    try {
        call.work();
    } catch (...) {
        call.thrown = std::current_exception();
    }
    return nullptr;
}

} // namespace

void run_on_deep_stack(const std::function<void()>& work)
{
    Call call { work, nullptr };
    pthread_t thread;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    const bool started
        = pthread_attr_setstacksize(&attributes, kStack) == 0 && pthread_create(&thread, &attributes, make, &call) == 0;
    pthread_attr_destroy(&attributes);
    if (started)
        pthread_join(thread, nullptr);
    else
        make(&call);
    if (call.thrown)
        std::rethrow_exception(call.thrown);
}

} // namespace vmlight
