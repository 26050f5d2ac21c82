#pragma once
/// \file What the coupled algorithm needs of parallel communication; every call is collective.
#include <gsl/span>

namespace cutterflow::coupling {

class Communicator {
public:
    virtual ~Communicator() = default;
    /// Element-wise sum over the ranks, in place, the same bits on every rank.
    virtual void sum(gsl::span<double> values) = 0;
    /// Element-wise maximum over the ranks, in place.
    virtual void max(gsl::span<double> values) = 0;
    virtual int rank() const = 0;
    virtual int size() const = 0;
};

/// One rank: nothing to exchange.
class SerialCommunicator final : public Communicator {
public:
    void sum(gsl::span<double>) override {}
    void max(gsl::span<double>) override {}
    int rank() const override { return 0; }
    int size() const override { return 1; }
};

}  // namespace cutterflow::coupling
