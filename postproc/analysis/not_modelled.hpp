#pragma once
/// \file What a run of Cutterflow does not model: the one table behind every page and results.json.
#include <string>
#include <vector>

#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

struct NotModelled {
    std::string name;
    std::string consequence;  ///< what a reader of the result must keep in mind
};

/// Of which runs rock goes through a recorded flow.
enum class Replays { none, some, all };

/// What a run was asked for.
struct Scope {
    bool with_rock = false;
    bool fed_by_cutting = false;  ///< rock comes all the time, from a cut face
    bool feels_bank = false;      ///< soil stands beside the head
    bool hauls = false;           ///< the run's frame travels with the head
    bool fed_by_layer = false;    ///< loose rock that the swing before left comes in, too
    Replays replays = Replays::none;
    bool of_one_run = true;
};

Scope scope_of(const RunData& run);

std::vector<NotModelled> not_modelled(const Scope& scope);

/// One sentence for the top of a page.
std::string scope_sentence(const Scope& scope);

}  // namespace cutterflow::postproc
