/// \file Writes docs/user/study_file.md and crown_file.md from the tables of keys.
#include "cases/study/study.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/head/crown_cutter.hpp"

int main() {
    const auto pages = cutterflow::installation().data / "docs/user";
    cutterflow::write_file(pages / "study_file.md", cutterflow::cases::study_manual_page());
    cutterflow::write_file(pages / "crown_file.md", cutterflow::geometry::crown_manual_page());
}
