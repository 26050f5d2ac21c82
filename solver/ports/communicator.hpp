#pragma once
/// \file What the coupled algorithm needs of parallel communication; every call is collective.
#include <vector>

#include <gsl/span>

namespace cutterflow::coupling {

/// What one rank has for another.
struct Parcel {
    int rank = 0;  ///< the other one
    std::vector<double> values;
};

class Communicator {
public:
    virtual ~Communicator() = default;
    /// Element-wise sum over the ranks, in place, the same bits on every rank.
    virtual void sum(gsl::span<double> values) = 0;
    /// Element-wise maximum over the ranks, in place.
    virtual void max(gsl::span<double> values) = 0;
    /// Replaces each parcel's values by those that its rank has for this one, by messages between the two alone. Ranks that have parcels
    /// for each other have one each, of equal length.
    virtual void swap(gsl::span<Parcel> parcels) = 0;
    virtual int rank() const = 0;
    virtual int size() const = 0;
};

/// One rank: nothing to exchange.
class SerialCommunicator final : public Communicator {
public:
    void sum(gsl::span<double>) override {}
    void max(gsl::span<double>) override {}
    void swap(gsl::span<Parcel>) override {}
    int rank() const override { return 0; }
    int size() const override { return 1; }
};

}  // namespace cutterflow::coupling
