// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/parallel.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/thread.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace vmlight;

TEST(Parallel, EveryItemIsDoneOnce)
{
    for (int threads : { 0, 1, 2, 7, 64 })
        for (int64_t items : { 0, 1, 2, 5, 1000 }) {
            std::vector<std::atomic<int>> done(size_t(items) + 1);
            EXPECT_TRUE(parallel_items(items, threads, [&](int64_t item, int) { ++done[size_t(item)]; }));
            for (int64_t i = 0; i < items; ++i)
                EXPECT_EQ(done[size_t(i)], 1) << threads << " threads, item " << i;
            EXPECT_EQ(done[size_t(items)], 0);
        }
}

TEST(Parallel, AWorkerDoesOneItemAtATime)
{
    for (int threads : { 0, 1, 3, 8 }) {
        const int workers = worker_count(threads);
        EXPECT_GE(workers, 1);
        if (threads) {
            EXPECT_EQ(workers, threads);
        }
        std::vector<std::atomic<int>> busy = std::vector<std::atomic<int>>(size_t(workers));
        std::atomic<int> faults { 0 };
        parallel_items(300, threads, [&](int64_t, int worker) {
            if (worker < 0 || worker >= workers) {
                ++faults;
                return;
            }
            faults += busy[size_t(worker)]++ != 0;
            std::this_thread::sleep_for(std::chrono::microseconds(20));
            --busy[size_t(worker)];
        });
        EXPECT_EQ(faults, 0) << threads;
    }
}

TEST(Parallel, OneThreadIsTheCallers)
{
    const auto caller = std::this_thread::get_id();
    parallel_items(10, 1, [&](int64_t, int worker) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(worker, 0);
    });
}

TEST(Parallel, ProgressGrowsToOneAndIsNeverToldTwiceAtOnce)
{
    for (int threads : { 1, 2, 7 })
        for (int run = 0; run < 20; ++run) {
            std::atomic<int> inside { 0 }, faults { 0 };
            double last = 0;
            EXPECT_TRUE(parallel_items(
                200, threads, [](int64_t, int) {},
                [&](double done) {
                    faults += inside++ != 0;
                    faults += done < last || done > 1;
                    last = done;
                    --inside;
                    return true;
                }));
            EXPECT_EQ(faults, 0);
            EXPECT_EQ(last, 1) << threads;
        }
}

TEST(Parallel, ProgressThatSaysNoStopsTheWork)
{
    for (int threads : { 1, 2, 7 }) {
        std::atomic<int64_t> done { 0 };
        EXPECT_FALSE(parallel_items(
            1000000, threads, [&](int64_t, int) { ++done; }, [&](double) { return done < 10; }));
        EXPECT_LT(done, 1000000);
        EXPECT_GE(done, 10);
    }
}

TEST(Parallel, AnExceptionInTheWorkReachesTheCaller)
{
    for (int threads : { 1, 2, 7 }) {
        std::atomic<int64_t> done { 0 };
        std::string caught;
        try {
            parallel_items(100000, threads, [&](int64_t item, int) {
                if (item == 20)
                    throw std::runtime_error("out of light");
                ++done;
            });
        } catch (const std::exception& exception) {
            caught = exception.what();
        }
        EXPECT_EQ(caught, "out of light") << threads;
        EXPECT_LT(done, 99999) << "the rest of the items are not begun";
    }
}

TEST(Parallel, WhoWaitsDoesNotTakeUpOtherTasks)
{
    // A thread makes, under a lock, what tasks in the pool's queue are waiting for: were it to take up one of them
    // while its helpers finish, it would wait for itself.
    for (int run = 0; run < 10; ++run) {
        std::mutex making;
        std::atomic<bool> begun { false };
        std::thread maker([&] {
            const std::lock_guard<std::mutex> lock(making);
            parallel_items(50, 0, [&](int64_t, int) {
                begun = true;
                std::this_thread::sleep_for(std::chrono::microseconds(200));
            });
        });
        while (!begun)
            std::this_thread::yield();
        std::vector<std::future<void>> tasks;
        for (int i = 0; i < 64; ++i)
            tasks.push_back(
                OIIO::default_thread_pool()->push([&](int) { const std::lock_guard<std::mutex> lock(making); }));
        maker.join();
        for (std::future<void>& task : tasks)
            task.wait();
    }
}

TEST(Parallel, AThreadAtAnItemTakesUpNoOther)
{
    // OIIO waits for its own loops by running what is queued. Here that would be another worker of the same call, which
    // wants the mutex that the waiting thread holds. With one thread in the pool some workers stay queued.
    const int threads = OIIO::default_thread_pool()->size();
    OIIO::default_thread_pool()->resize(1);
    for (int repetition = 0; repetition < 20; ++repetition) {
        std::mutex making;
        std::atomic<int> done { 0 };
        const auto work = [&](int64_t, int) {
            const std::lock_guard<std::mutex> lock(making);
            const OIIO::ImageBuf zeros(OIIO::ImageSpec(512, 512, 1, OIIO::TypeFloat), OIIO::InitializePixels::Yes);
            ++done;
        };
        EXPECT_TRUE(parallel_items(16, 4, work));
        EXPECT_EQ(done, 16);
    }
    OIIO::default_thread_pool()->resize(threads);
}
