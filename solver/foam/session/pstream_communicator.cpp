#include "solver/foam/session/pstream_communicator.hpp"

#include <mpi.h>

namespace cutterflow::foam {
namespace {

constexpr int k_parcel_tag = 7301;  // of no message of OpenFOAM or LIGGGHTS

/// Reduced on one rank and then sent to all: MPI promises the same bits everywhere only for this pair, not for MPI_Allreduce.
void reduce_for_all(gsl::span<double> values, MPI_Op operation, int rank) {
    const int count = static_cast<int>(values.size());
    const void* send = rank == 0 ? MPI_IN_PLACE : values.data();
    MPI_Reduce(send, values.data(), count, MPI_DOUBLE, operation, 0, MPI_COMM_WORLD);
    MPI_Bcast(values.data(), count, MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

}  // namespace

PstreamCommunicator::PstreamCommunicator() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

void PstreamCommunicator::sum(gsl::span<double> values) {
    if (size_ > 1) reduce_for_all(values, MPI_SUM, rank_);
}

void PstreamCommunicator::max(gsl::span<double> values) {
    if (size_ > 1) reduce_for_all(values, MPI_MAX, rank_);
}

void PstreamCommunicator::swap(gsl::span<coupling::Parcel> parcels) {
    std::vector<std::vector<double>> received;
    std::vector<MPI_Request> requests;
    for (const coupling::Parcel& parcel : parcels) {
        std::vector<double>& there = received.emplace_back(parcel.values.size());
        MPI_Irecv(there.data(), static_cast<int>(there.size()), MPI_DOUBLE, parcel.rank, k_parcel_tag, MPI_COMM_WORLD,
                  &requests.emplace_back());
    }
    for (const coupling::Parcel& parcel : parcels)
        MPI_Isend(parcel.values.data(), static_cast<int>(parcel.values.size()), MPI_DOUBLE, parcel.rank, k_parcel_tag, MPI_COMM_WORLD,
                  &requests.emplace_back());
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    for (std::size_t k = 0; k < received.size(); ++k) parcels[static_cast<gsl::index>(k)].values.swap(received[k]);
}

}  // namespace cutterflow::foam
