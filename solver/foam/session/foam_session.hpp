#pragma once
/// \file One OpenFOAM program: MPI, command line, floating-point traps, time and mesh.
#include <filesystem>
#include <memory>

namespace Foam {
class Time;
class dynamicFvMesh;
}  // namespace Foam

namespace cutterflow::foam {

/// Owns what an OpenFOAM application sets up before its first field. MPI is started here, also in serial, because LIGGGHTS runs on
/// MPI_COMM_WORLD; it ends with the process, unless the program that started it first ends it.
class FoamSession {
public:
    /// Opens the case that the command line names (-case, -parallel, -help ... as in every OpenFOAM application; `argc`, `argv` as main
    /// got them). Mistakes on the command line end the program as OpenFOAM does.
    /// \throws CaseFileError  when OpenFOAM cannot open the case
    FoamSession(int argc, char** argv);

    /// Opens a case without a command line. On several MPI ranks the case must be decomposed, one processor folder per rank.
    /// \throws CaseFileError  as above
    explicit FoamSession(const std::filesystem::path& case_folder);

    ~FoamSession();
    FoamSession(const FoamSession&) = delete;
    FoamSession& operator=(const FoamSession&) = delete;

    Foam::Time& time();
    /// Read when it is asked for the first time; collective then. \throws CaseFileError  when OpenFOAM cannot read it
    Foam::dynamicFvMesh& mesh();

    /// The case's own folder (not a processor's).
    const std::filesystem::path& case_folder() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace cutterflow::foam
