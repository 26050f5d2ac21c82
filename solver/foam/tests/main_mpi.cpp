/// \file Runs GoogleTest on every MPI rank; ranks other than 0 report only what fails.
#include <mpi.h>

#include <cstdio>

#include <gtest/gtest.h>

#include "messageStream.H"

namespace {

class FailurePrinter : public ::testing::EmptyTestEventListener {
public:
    explicit FailurePrinter(int rank) : rank_(rank) {}

private:
    // GoogleTest holds its lock while it tells of a failure: asking it for the test then would wait for ever.
    void OnTestStart(const ::testing::TestInfo& test) override { test_ = &test; }

    void OnTestPartResult(const ::testing::TestPartResult& result) override {
        if (!result.failed()) return;
        std::printf("rank %d, %s.%s, %s:%d\n%s\n", rank_, test_->test_suite_name(), test_->name(), result.file_name(), result.line_number(),
                    result.message());
        std::fflush(stdout);
    }

    int rank_;
    const ::testing::TestInfo* test_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    ::testing::InitGoogleTest(&argc, argv);
    Foam::messageStream::level = 0;  // solvers' logs would hide the tests'
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    if (rank != 0) {
        delete listeners.Release(listeners.default_result_printer());
        listeners.Append(new FailurePrinter(rank));
    }
    int failed = RUN_ALL_TESTS();
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    MPI_Finalize();
    return failed;
}
