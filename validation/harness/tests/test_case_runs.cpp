/// The suite's runner with shell scripts in the place of cases.
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "validation/harness/suite/case_runs.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string quantity(const std::string& verdict) {
    return R"({"quantity":"speed","unit":"m/s","reference":1.0,"value":1.1,"error":0.1,"tolerance":0.2,"aim":0.05,)"
           R"("rule":"relative","verdict":")" +
           verdict + R"(","source":"Legendre2006","note":"a cause"})";
}

class VerificationRun : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        root_ = fs::temp_directory_path() / ("cutterflow_verify_" + std::string(test->name()));
        fs::remove_all(root_);
        places_ = {root_ / "cases", root_ / "programs", root_ / "bin", root_ / "kept", root_ / "examples"};
        settings_.folder = root_ / "results";
        fs::create_directories(places_.programs);
    }
    void TearDown() override { fs::remove_all(root_); }

    void add_case(const std::string& name, const std::string& script, const std::string& head = "- class: fast\n") {
        write_file(places_.cases / name / "README.md", "# Case " + name + "\n\n" + head + "\nText.\n");
        if (script.empty()) return;
        write_file(places_.programs / name, "#!/bin/sh\n" + script + "\n");
        fs::permissions(places_.programs / name, fs::perms::owner_all);
    }
    /// A case that finds one quantity and adds a line to a file each time it runs.
    void add_case_with(const std::string& name, const std::string& verdict) {
        add_case(name, fmt::format("echo run >> {}\necho '[{}]' > $2/quantities.json\n{}", (root_ / (name + ".runs")).string(),
                                   quantity(verdict), verdict == "fail" ? "exit 4" : "exit 0"));
    }
    std::size_t times_run(const std::string& name) const {
        return fs::exists(root_ / (name + ".runs")) ? fs::file_size(root_ / (name + ".runs")) / 4 : 0;
    }
    std::vector<VerifiedCase> run() {
        return run_verification(find_verification_cases(places_.cases), places_, settings_, [](const std::string&) {});
    }

    fs::path root_;
    VerificationPlaces places_;
    VerificationSettings settings_;
};

TEST_F(VerificationRun, tells_each_case_by_what_its_program_found) {
    add_case_with("bad", "fail");
    add_case_with("good", "pass");
    add_case_with("loose", "not converged");
    const auto results = run();
    ASSERT_EQ(results.size(), 3u);
    EXPECT_EQ(results[0].verdict(), CaseVerdict::fail);
    EXPECT_EQ(results[1].verdict(), CaseVerdict::pass);
    EXPECT_EQ(results[1].title, "Case good");
    EXPECT_EQ(results[1].quantities.at(0).value, 1.1);
    EXPECT_EQ(results[2].verdict(), CaseVerdict::not_converged);
    EXPECT_EQ(read_verification(settings_.folder).size(), 3u) << "every case has its file";
}

TEST_F(VerificationRun, skips_what_cannot_run_here_and_never_passes_it) {
    add_case("unbuilt", "");
    add_case("bare", "exit 0", "- class: fast\n- needs: sh, noSuchSolver\n");
    for (const VerifiedCase& result : run()) {
        EXPECT_EQ(result.verdict(), CaseVerdict::skipped);
        EXPECT_FALSE(result.reason.empty());
    }
    EXPECT_THAT(read_verification(settings_.folder)[0].reason, HasSubstr("noSuchSolver not found"));
}

TEST_F(VerificationRun, a_program_that_breaks_or_says_nothing_fails) {
    add_case("crash", "echo 'the mesh is gone'; exit 3");
    add_case("killed", "kill -9 $$");
    for (const VerifiedCase& result : run()) EXPECT_EQ(result.verdict(), CaseVerdict::fail);
    const auto kept = read_verification(settings_.folder);
    EXPECT_EQ(kept[0].verdict(), CaseVerdict::fail);
    EXPECT_THAT(kept[0].reason, HasSubstr("the mesh is gone"));
    EXPECT_FALSE(kept[0].stopped);
    EXPECT_TRUE(kept[1].stopped);
    add_case("silent", "exit 0");
    EXPECT_EQ(run().back().verdict(), CaseVerdict::fail);
}

TEST_F(VerificationRun, resume_keeps_what_the_same_programs_finished) {
    add_case_with("one", "pass");
    run();
    settings_.resume = true;
    add_case_with("two", "pass");
    run();
    EXPECT_EQ(times_run("one"), 1u);
    EXPECT_EQ(times_run("two"), 1u);
    settings_.effort = Effort::longest;  // asks for more than what was done
    run();
    EXPECT_EQ(times_run("one"), 2u);
    write_file(places_.tools / "cutterFoam", "another solver");
    run();
    EXPECT_EQ(times_run("one"), 3u);
    settings_.resume = false;
    run();
    EXPECT_EQ(times_run("two"), 4u);
}

TEST_F(VerificationRun, resume_runs_again_what_needs_a_program_that_changed) {
    write_file(places_.tools / "cutterflow", "the program");
    add_case("study", fmt::format("echo run >> {}\necho '[{}]' > $2/quantities.json", (root_ / "study.runs").string(), quantity("pass")),
             "- class: fast\n- needs: cutterflow\n");
    run();
    settings_.resume = true;
    run();
    EXPECT_EQ(times_run("study"), 1u);
    write_file(places_.tools / "cutterflow", "with other defaults");
    run();
    EXPECT_EQ(times_run("study"), 2u);
}

TEST_F(VerificationRun, resume_runs_again_what_reads_a_file_that_changed) {
    write_file(places_.examples / "heap/study.toml", "friction = 0.5\n");
    write_file(places_.examples / "heap/README.md", "A heap.\n");
    add_case("study", fmt::format("echo run >> {}\necho '[{}]' > $2/quantities.json", (root_ / "study.runs").string(), quantity("pass")),
             "- class: fast\n- examples: heap\n");
    write_file(places_.cases / "study/reference.csv", "1\n");
    run();
    settings_.resume = true;
    write_file(places_.examples / "heap/README.md", "A heap of gravel.\n");
    write_file(places_.examples / "other/study.toml", "friction = 0.4\n");
    run();
    EXPECT_EQ(times_run("study"), 1u);
    write_file(places_.examples / "heap/study.toml", "friction = 0.6\n");
    run();
    EXPECT_EQ(times_run("study"), 2u);
    write_file(places_.cases / "study/reference.csv", "2\n");
    run();
    EXPECT_EQ(times_run("study"), 3u);
}

TEST_F(VerificationRun, counts_the_cost_of_all_starts_that_went_on) {
    add_case("goes_on", fmt::format("echo '[{}]' > $2/quantities.json", quantity("pass")), "- class: fast\n- resumes: yes\n");
    run();
    const auto core_s = [&] { return read_verification(settings_.folder).at(0).core_s; };
    const fs::path spent = settings_.folder / "goes_on/core_s";
    EXPECT_NEAR(std::stod(read_file(spent)), core_s(), 1e-9);
    write_file(spent, "1000\n");
    settings_.resume = true;
    fs::remove(settings_.folder / "goes_on.json");
    run();
    EXPECT_GT(core_s(), 1000.0);
    settings_.resume = false;
    run();
    EXPECT_LT(core_s(), 1000.0) << "it began anew";
}

TEST_F(VerificationRun, replaces_no_result_with_one_of_less_effort) {
    add_case_with("one", "pass");
    settings_.effort = Effort::standard;
    run();
    settings_.effort = Effort::fast;
    EXPECT_THROW(run(), UserError);
    EXPECT_EQ(read_verification(settings_.folder).at(0).effort, "standard");
    settings_.resume = true;
    run();
    EXPECT_EQ(times_run("one"), 1u);
}

TEST_F(VerificationRun, deletes_what_the_case_left_and_nothing_else) {
    add_case("one", fmt::format("echo grown > $2/field\necho '[{}]' > $2/quantities.json", quantity("pass")));
    run();
    run();
    const fs::path work = settings_.folder / "one", kept = settings_.folder / "one_kept_1";
    EXPECT_FALSE(fs::exists(kept)) << "all files were the case's own";
    write_file(work / "notes/mine.txt", "a week of work");
    run();
    EXPECT_EQ(read_file(kept / "notes/mine.txt"), "a week of work");
    EXPECT_EQ(read_file(kept / "field"), "grown\n");
    EXPECT_FALSE(fs::exists(work / "notes"));
    write_file(work / "field", "changed by hand");
    run();
    EXPECT_EQ(read_file(settings_.folder / "one_kept_2/field"), "changed by hand");
}

TEST_F(VerificationRun, keeps_what_the_user_added_to_a_case_that_goes_on) {
    add_case("one", fmt::format("touch $2/field\necho '[{}]' > $2/quantities.json", quantity("fail")), "- class: fast\n- resumes: yes\n");
    run();
    write_file(settings_.folder / "one/mine.txt", "mine");
    settings_.resume = true;
    fs::remove(settings_.folder / "one.json");  // as if the suite itself had been killed
    run();
    EXPECT_TRUE(fs::exists(settings_.folder / "one/mine.txt"));
    settings_.resume = false;
    run();
    EXPECT_EQ(read_file(settings_.folder / "one_kept_1/mine.txt"), "mine");
}

TEST_F(VerificationRun, refuses_a_case_folder_and_a_result_of_other_origin) {
    add_case_with("one", "pass");
    write_file(settings_.folder / "verification", "Results of cutterflow verify.\n");
    write_file(settings_.folder / "one/system/controlDict", "the user's own case");
    EXPECT_THROW(run(), UserError);
    EXPECT_EQ(read_file(settings_.folder / "one/system/controlDict"), "the user's own case");
    fs::rename(settings_.folder / "one", settings_.folder / "elsewhere");
    write_file(settings_.folder / "one.json", "[1, 2]");
    EXPECT_THROW(run(), UserError);
    EXPECT_EQ(read_file(settings_.folder / "one.json"), "[1, 2]");
    EXPECT_EQ(times_run("one"), 0u);
}

TEST_F(VerificationRun, fails_a_case_that_refuses_its_input_goes_on_and_passes_over_files_of_others) {
    add_case("bad_reference", "echo 'reference.csv:3: \"nan\"'; exit 2");
    add_case_with("good", "pass");
    const std::vector<VerifiedCase> results = run();
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[0].verdict(), CaseVerdict::fail);
    EXPECT_THAT(results[0].reason, HasSubstr("reference.csv:3"));
    EXPECT_EQ(results[1].verdict(), CaseVerdict::pass);
    fs::remove_all(settings_.folder);
    fs::create_directories(settings_.folder);
    write_file(settings_.folder / "all.json", "[]");
    write_file(settings_.folder / "empty.json", "");
    EXPECT_TRUE(read_verification(settings_.folder).empty());
}

TEST_F(VerificationRun, resume_leaves_the_begun_work_of_cases_that_go_on_with_it) {
    // Each start finds one file more, as long as it may go on.
    const std::string script =
        fmt::format("touch $2/part_$(ls $2 | grep -c part)\nls $2 | grep -c part > {}/$(basename $2).parts\nkill -9 $$", root_.string());
    add_case("goes_on", script, "- class: fast\n- resumes: yes\n");
    add_case("begins_anew", script);
    const auto parts = [&](const std::string& name) { return read_file(root_ / (name + ".parts")); };
    run();
    settings_.resume = true;
    run();
    EXPECT_EQ(parts("goes_on"), "2\n");
    EXPECT_EQ(parts("begins_anew"), "1\n");
    write_file(places_.tools / "cutterFoam", "another solver");
    run();
    EXPECT_EQ(parts("goes_on"), "1\n");
    run();
    EXPECT_EQ(parts("goes_on"), "2\n");
    settings_.resume = false;
    run();
    EXPECT_EQ(parts("goes_on"), "1\n");
}

TEST_F(VerificationRun, refuses_unknown_names_wrong_heads_and_folders_of_others) {
    add_case_with("settling", "pass");
    add_case_with("couette", "pass");
    const auto all = find_verification_cases(places_.cases);
    EXPECT_EQ(select_cases(all, {"settling"}).at(0).name, "settling");
    try {
        select_cases(all, {"setling", "x"});
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.mistakes().size(), 2u);
        EXPECT_THAT(error.what(), HasSubstr("The cases are couette, settling"));
        EXPECT_THAT(error.what(), HasSubstr("Did you mean settling?"));
    }
    write_file(root_ / "thesis/chapter.tex", "mine");
    settings_.folder = root_ / "thesis";
    EXPECT_THROW(run(), UserError);
    add_case("headless", "exit 0", "- class: quick\n");
    EXPECT_THROW(find_verification_cases(places_.cases), UserError);
}

TEST_F(VerificationRun, keeps_the_result_that_was_run_with_more_effort) {
    VerifiedCase older, newer;
    older.name = newer.name = "settling";
    older.effort = "standard";
    newer.effort = "fast";
    older.quantities = newer.quantities = {quantity_from_json(nlohmann::json::parse(quantity("pass")), "here")};
    EXPECT_EQ(merged_verification({older}, {newer}).at(0).effort, "standard");
    EXPECT_EQ(merged_verification({newer}, {older}).at(0).effort, "standard");
    newer.quantities = {quantity_from_json(nlohmann::json::parse(quantity("fail")), "here")};
    EXPECT_EQ(merged_verification({older}, {newer}).at(0).verdict(), CaseVerdict::fail) << "a failure gives way to nothing";
    newer.quantities = older.quantities;
    newer.effort = "long";
    EXPECT_EQ(merged_verification({older}, {newer}).at(0).effort, "long");
    newer.quantities.clear();
    EXPECT_EQ(merged_verification({older}, {newer}).at(0).effort, "standard") << "a skipped case replaces nothing";
    newer.failed_as_a_whole = newer.stopped = true;
    EXPECT_EQ(merged_verification({older}, {newer}).at(0).effort, "standard") << "a kill is no finding";
    EXPECT_TRUE(merged_verification({}, {newer}).empty());
    VerifiedCase old = older;
    old.date = "2026-01-01 10:00";
    older.date = "2026-01-02 09:00";
    older.quantities[0].value = 2.0;
    EXPECT_EQ(merged_verification({older}, {old}).at(0).date, older.date) << "a week-old folder does not replace what came later";
    EXPECT_EQ(merged_verification({old}, {older}).at(0).date, older.date);
    old.effort = "long";
    EXPECT_EQ(merged_verification({older}, {old}).at(0).effort, "long") << "more was done";
}

TEST_F(VerificationRun, resume_does_not_replace_dearer_results_of_other_programs) {
    add_case_with("one", "pass");
    settings_.effort = Effort::longest;
    run();
    settings_.effort = Effort::fast;
    settings_.resume = true;
    run();
    EXPECT_EQ(times_run("one"), 1u);
    write_file(places_.tools / "cutterFoam", "another solver");
    EXPECT_THROW(run(), UserError);
    EXPECT_EQ(read_verification(settings_.folder).at(0).effort, "long");
}

TEST_F(VerificationRun, pages_name_every_shortfall_with_its_cause) {
    add_case_with("bad", "fail");
    add_case_with("good", "pass");
    add_case("unbuilt", "");
    const auto results = run();
    const std::string markdown = verification_markdown(results, "../cases/");
    EXPECT_THAT(markdown, HasSubstr("1 of 2 quantities of 3 cases pass"));
    EXPECT_THAT(markdown, HasSubstr("[bad](#bad), speed [m/s], **fail**: 10 % where ≤ 20 % is asked. a cause"));
    EXPECT_THAT(markdown, HasSubstr("[unbuilt](#unbuilt), skipped: its program"));
    EXPECT_THAT(markdown, HasSubstr("(../cases/good/README.md)"));
    const std::string page = verification_page(results, "../cases/", root_ / "charts");
    EXPECT_THAT(page, HasSubstr("<span class=\"failed\">fail</span>: 10 % where ≤ 20 % is asked. a cause"));
    EXPECT_THAT(page, HasSubstr("not built"));
    EXPECT_THAT(page, HasSubstr("<a href=\"#good\">good</a>, speed [m/s]: 10 % where ≤ 5 % is the aim"));
    EXPECT_THAT(markdown, HasSubstr("[good](#good), speed [m/s]: 10 % where ≤ 5 % is the aim"));
}

TEST_F(VerificationRun, shows_tables_and_charts_and_keeps_them_with_the_result) {
    Exhibits exhibits;
    exhibits.tables = {{"Matrix", {"what", "outcome"}, {{"d/dx 0.2", "stable | slow"}}}};
    exhibits.charts = {{"kernel width", "core seconds", "error, %", {{"0.5", 10.0, 2.5, false}, {"1", 20.0, 0.0, true}}}};
    add_case("shows", fmt::format("echo '[{}]' > $2/quantities.json\necho '{}' > $2/exhibits.json", quantity("pass"),
                                  exhibits_json(exhibits).dump()));
    run();
    const auto results = read_verification(settings_.folder);
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(exhibits_json(results[0].exhibits), exhibits_json(exhibits));
    const std::string markdown = verification_markdown(results, "../cases/");
    EXPECT_THAT(markdown, HasSubstr("### Matrix"));
    EXPECT_THAT(markdown, HasSubstr("| d/dx 0.2 | stable \\| slow |"));
    EXPECT_THAT(markdown, HasSubstr("| 1 (default) | 20 | 0 |"));
    const std::string page = verification_page(results, "../cases/", root_ / "charts");
    EXPECT_THAT(page, HasSubstr("stable | slow"));
    if (postproc::gnuplot_is_installed()) EXPECT_THAT(page, HasSubstr("1 (default)"));
}

}  // namespace
}  // namespace cutterflow::validation
