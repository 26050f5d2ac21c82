/// \file Writes docs/user/study_file.md from the table of study keys.
#include "cases/study.hpp"
#include "geometry/base/file_content.hpp"

int main() {
    cutterflow::write_file(CUTTERFLOW_SOURCE_DIR "/docs/user/study_file.md", cutterflow::cases::study_manual_page());
}
