#pragma once
/// \file The coupling's Communicator over the MPI ranks of the OpenFOAM run.
#include "solver/ports/communicator.hpp"

namespace cutterflow::foam {

/// Every call is collective over MPI_COMM_WORLD, which a FoamSession has started.
class PstreamCommunicator final : public coupling::Communicator {
public:
    PstreamCommunicator();
    void sum(gsl::span<double> values) override;
    void max(gsl::span<double> values) override;
    void swap(gsl::span<coupling::Parcel> parcels) override;
    int rank() const override { return rank_; }
    int size() const override { return size_; }

private:
    int rank_ = 0;
    int size_ = 1;
};

}  // namespace cutterflow::foam
