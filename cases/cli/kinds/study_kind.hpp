#pragma once
/// \file The kinds of studies that the command line knows: one row each in study_kinds().
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cases/sweep/sweep.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cli {

struct NewOptions {
    std::string study = "study.toml";
    std::string cutter;
    std::optional<std::string> unit;
    std::string kind;
};

struct CheckOptions {
    std::string study;
    int ranks = 1;
    bool json = false;
};

struct RunOptions {
    std::string study;
    std::optional<std::string> output;
    int ranks = 1;
    std::string start_from;
    bool resume = false;
    bool json = false;

    std::filesystem::path folder() const {
        return output ? std::filesystem::path(*output) : std::filesystem::path("runs") / std::filesystem::path(study).stem();
    }
};

struct ReportOptions {
    std::string folder;
    std::optional<std::string> adv_points;
    std::optional<int> revolutions;
    std::optional<std::string> still_folder;
    bool adv_template = false;
    bool json = false;
};

struct SweepOptions {
    std::string study;
    std::optional<std::string> output;
    cases::SweepAxes axes;
    std::vector<std::string> set;  ///< other keys of the study
    int ranks = 1;
    bool resume = false;
    std::string launcher = "local";
    bool emit = false;
    int replays = 0;           ///< of every setting; 0: none
    std::string replay_study;  ///< whose rock is replayed; empty: the study's own
};

struct CompareOptions {
    std::vector<std::string> runs;
    std::optional<std::string> output, still_folder;
    std::vector<std::string> measured;
    bool measured_template = false;
    bool json = false;
};

/// What the commands do with a study of one kind. What a kind has no use for, it refuses by name.
struct StudyKind {
    const char* name;    ///< as --kind and the study file write it
    const char* what;    ///< is studied
    const char* params;  ///< the command that lists its keys
    const ParameterTable& (*table)();
    std::string (*new_study)(const NewOptions&);
    void (*check)(const CheckOptions&);
    std::optional<double> (*predicted_core_s)(const std::filesystem::path& study);  ///< none: it depends on the machine
    void (*mesh)(const RunOptions&);                                                ///< stages that points of a sweep may share
    void (*run)(const RunOptions&);
    bool (*is_run)(const std::filesystem::path&);  ///< whether a run directory is of the kind
    void (*report)(const ReportOptions&);
    std::vector<cases::SweepPoint> (*points)(const SweepOptions&, const std::filesystem::path& folder);
    bool replays;  ///< whether its runs record a flow that can be replayed
    std::filesystem::path (*write_comparison)(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& folder);
    void (*compare)(const CompareOptions&);
};

/// The cutter first: a study that names no kind is one.
const std::vector<StudyKind>& study_kinds();
std::vector<std::string> kind_names();

/// \pre there is one of that name
const StudyKind& kind_named(const std::string& name);
/// By the file's key `kind` or `scene.kind`; a file that is missing or no TOML counts as a cutter's, whose reader tells what is wrong.
/// \throws UserError  when the file names another kind, or none and is no cutter's study
const StudyKind& kind_of_study(const std::filesystem::path& file);
const StudyKind& kind_of_run(const std::filesystem::path& folder);

extern const StudyKind k_cutter_kind, k_surface_kind, k_room_kind;

}  // namespace cutterflow::cli
