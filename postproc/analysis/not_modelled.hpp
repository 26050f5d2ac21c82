#pragma once
/// \file What no run of Cutterflow models yet: the one table behind every page and results.json.
#include <string>
#include <vector>

namespace cutterflow::postproc {

struct NotModelled {
    std::string name;
    std::string consequence;  ///< what a reader of the result must keep in mind
};

const std::vector<NotModelled>& not_modelled();

/// One sentence for the top of a page of a run with or without rock.
const std::string& scope_sentence(bool with_rock);

}  // namespace cutterflow::postproc
