#pragma once
/// \file Several ranks in one process: each is a thread with a Communicator.
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "solver/ports/communicator.hpp"

namespace cutterflow::coupling::testing {

/// Runs `body` once per rank, all at the same time; the first exception of a rank is thrown again (all ranks must throw alike).
class ThreadedRanks {
public:
    explicit ThreadedRanks(int ranks) : parts_(static_cast<std::size_t>(ranks)), mail_(parts_.size()) {}

    void run(const std::function<void(Communicator&)>& body) {
        std::vector<std::thread> threads;
        std::vector<std::exception_ptr> failures(parts_.size());
        for (int rank = 0; rank < static_cast<int>(parts_.size()); ++rank)
            threads.emplace_back([&, rank] {
                Rank communicator(*this, rank);
                try {
                    body(communicator);
                } catch (...) {
                    failures[static_cast<std::size_t>(rank)] = std::current_exception();
                }
            });
        for (std::thread& thread : threads) thread.join();
        for (const std::exception_ptr& failure : failures)
            if (failure) std::rethrow_exception(failure);
    }

private:
    class Rank final : public Communicator {
    public:
        Rank(ThreadedRanks& all, int rank) : all_(all), rank_(rank) {}
        void sum(gsl::span<double> values) override {
            all_.combine(rank_, values, [](double a, double b) { return a + b; });
        }
        void max(gsl::span<double> values) override {
            all_.combine(rank_, values, [](double a, double b) { return a > b ? a : b; });
        }
        void swap(gsl::span<Parcel> parcels) override { all_.deliver(rank_, parcels); }
        int rank() const override { return rank_; }
        int size() const override { return static_cast<int>(all_.parts_.size()); }

    private:
        ThreadedRanks& all_;
        int rank_;
    };

    void combine(int rank, gsl::span<double> values, const std::function<double(double, double)>& join) {
        parts_[static_cast<std::size_t>(rank)].assign(values.begin(), values.end());
        wait();
        for (std::size_t i = 0; i < static_cast<std::size_t>(values.size()); ++i) {
            values[static_cast<gsl::index>(i)] = parts_[0].at(i);
            for (std::size_t r = 1; r < parts_.size(); ++r)
                values[static_cast<gsl::index>(i)] = join(values[static_cast<gsl::index>(i)], parts_[r].at(i));
        }
        wait();
    }

    void deliver(int rank, gsl::span<Parcel> parcels) {
        std::map<int, std::vector<double>>& sent = mail_[static_cast<std::size_t>(rank)];
        for (const Parcel& parcel : parcels) sent[parcel.rank] = parcel.values;
        wait();
        for (Parcel& parcel : parcels) {
            const std::vector<double>& here = mail_[static_cast<std::size_t>(parcel.rank)].at(rank);
            if (here.size() != parcel.values.size()) throw std::logic_error("two ranks swap parcels of unequal length");
            parcel.values = here;
        }
        wait();
        sent.clear();
    }

    void wait() {
        std::unique_lock<std::mutex> lock(mutex_);
        const int generation = generation_;
        if (++waiting_ == static_cast<int>(parts_.size())) {
            waiting_ = 0;
            ++generation_;
            condition_.notify_all();
            return;
        }
        condition_.wait(lock, [&] { return generation_ != generation; });
    }

    std::vector<std::vector<double>> parts_;
    std::vector<std::map<int, std::vector<double>>> mail_;  // by sender and receiver
    std::mutex mutex_;
    std::condition_variable condition_;
    int waiting_ = 0;
    int generation_ = 0;
};

}  // namespace cutterflow::coupling::testing
