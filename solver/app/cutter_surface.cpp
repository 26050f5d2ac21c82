/// \file cutterSurface: water with a free surface and the solids that it carries, from a scene.toml.
///
///     cutterSurface CASE             runs CASE/scene.toml; refuses a folder with a run in it
///     cutterSurface CASE --resume    goes on from the newest checkpoint
///     cutterSurface CASE --check     checks the scene and says what a run will take
///     cutterSurface --template       prints every key with its help
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <mpi.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/process/processor_time.hpp"
#include "geometry/base/progress.hpp"
#include "solver/app/stop_request.hpp"
#include "solver/free_surface/output/surface_checkpoint.hpp"
#include "solver/free_surface/output/surface_recorder.hpp"
#include "solver/free_surface/scene_file/scene_file.hpp"
#include "solver/liggghts/liggghts_engine.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::free_surface;
namespace fs = std::filesystem;

constexpr const char* k_scene = "scene.toml";
constexpr const char* k_walls = "walls_of_bodies";       // what bodies bump into: a folder of the program's own
constexpr const char* k_ends = "ends_at_s";              // when the run ends that met its stop rule
constexpr const char* k_started = "scene.started.toml";  // the scene as it was when the run began

struct Arguments {
    fs::path folder;
    bool resume = false, check = false, print_template = false;
};

Arguments read_arguments(int argc, char** argv) {
    Arguments arguments;
    for (int n = 1; n < argc; ++n) {
        const std::string word = argv[n];
        if (word == "--resume") {
            arguments.resume = true;
        } else if (word == "--check") {
            arguments.check = true;
        } else if (word == "--template") {
            arguments.print_template = true;
        } else if (arguments.folder.empty() && word.rfind("--", 0) != 0) {
            arguments.folder = word;
        } else {
            throw UserError("argument " + word, "cutterSurface CASE [--check | --resume], or --template", "Correct it");
        }
    }
    if (arguments.folder.empty() && !arguments.print_template)
        throw UserError("no case folder is given", "cutterSurface CASE [--check | --resume]", "Name the folder that holds scene.toml");
    return arguments;
}

void tell(const Scene& scene) {
    const ScenePrediction found = predict(scene);
    std::cout << fmt::format("{}: {:.0f} cells, {:.0f} of water, {:.0f} particles, {} bodies\n", scene.name, found.cells, found.water_cells,
                             found.particles, scene.bodies.size())
              << fmt::format("about {:.0f} steps of {:.2g} s, {:.1f} core minutes\n", found.steps, found.step, found.core_seconds / 60.0);
    if (found.dem_step > 0.0) std::cout << fmt::format("contact step {:.4g} s\n", found.dem_step);
    for (const std::string& line : scene.close) std::cout << line << '\n';
    for (const std::string& note : scene.notes) std::cout << "note: " << note << '\n';
    for (const std::string& note : water_notes(scene)) std::cout << "note: " << note << '\n';
    std::cout << std::flush;
}

void require_one_rank() {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (ranks > 1) throw UserError(fmt::format("{} ranks", ranks), "A scene with a free surface runs on one", "Start it without mpirun");
}

std::unique_ptr<liggghts::LiggghtsEngine> make_bodies(Scene& scene, const fs::path& folder, bool fresh) {
    if (scene.bodies.size() == 0) return nullptr;
    const fs::path walls = folder / k_walls;
    fs::create_directories(walls);
    const auto add_wall = [&](const std::string& name, const std::string& stl) -> coupling::WallSettings& {
        write_file(walls / (name + ".stl"), stl);
        return scene.dem.walls.emplace_back(coupling::WallSettings{name, walls / (name + ".stl")});
    };
    const double depth = scene.settings.tank.depth;
    if (const std::string solids = wall_surface_stl(scene.settings.solids, depth); !solids.empty()) add_wall("solids", solids);
    for (std::size_t n = 0; n < scene.settings.gates.size(); ++n) {
        const Gate& gate = scene.settings.gates[n];
        add_wall(fmt::format("gate_{}", n + 1), wall_surface_stl({gate.closed}, depth)).travels = {
            {Vec3(0, 0, gate.speed), gate.start, gate.end}};
    }
    scene.dem.log = folder / "log.liggghts";
    auto engine = std::make_unique<liggghts::LiggghtsEngine>(scene.dem, std::vector<coupling::ZoneMotion>{}, MPI_COMM_WORLD);
    if (!fresh) return engine;
    const std::vector<int> taken = engine->insert(scene.bodies);
    std::vector<Mistake> mistakes;
    for (const int id : scene.bodies.id) {
        if (!std::binary_search(taken.begin(), taken.end(), id))
            mistakes.push_back({k_scene, fmt::format("Body {} stands in a wall or a solid", id), "Bodies start free", "Move the stack"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return engine;
}

/// What the folder must hold or not hold for a run to begin.
void require_free_or_own(const fs::path& folder, const std::string& scene, bool resume) {
    const fs::path started = folder / k_started;
    if (!fs::exists(started)) {
        if (resume) throw UserError(folder.string() + " has no run to go on with", "--resume needs one", "Start without --resume");
        return;
    }
    if (read_file(started) != scene)
        throw UserError(folder.string() + " holds a run of another scene", "A folder holds one run",
                        "Take a new folder for the changed scene");
    if (!resume) throw UserError(folder.string() + " holds a run already", "Nothing is overwritten", "Add --resume, or take a new folder");
}

/// The next whole multiple of an interval after a time.
double next_multiple(double time, double interval) {
    return (std::floor(time / interval * (1.0 + 1e-12) + 1e-9) + 1.0) * interval;
}

/// \throws Interrupted  after a checkpoint, at a request to stop
void run_scene(const Arguments& arguments) {
    if (!arguments.check) listen_for_stop();
    Scene scene = read_scene(arguments.folder / k_scene);
    tell(scene);
    if (arguments.check) return;
    const std::string text = read_file(arguments.folder / k_scene);
    require_free_or_own(arguments.folder, text, arguments.resume);
    const fs::path checkpoint = arguments.resume ? newest_checkpoint(arguments.folder) : fs::path{};
    const auto engine = make_bodies(scene, fs::absolute(arguments.folder), checkpoint.empty());
    write_file(arguments.folder / k_started, text);  // what could be refused was not
    const StaggeredGrid grid = scene.settings.tank.grid();
    std::optional<SurfaceState> state;
    if (!checkpoint.empty()) state = read_checkpoint(checkpoint, grid, engine.get());
    SurfaceRun run(scene.settings, engine.get());
    if (state) run.restore(std::move(*state));

    SurfaceRecorder recorder(arguments.folder, run.time(), scene.gauges, scene.write_particles);
    if (run.time() == 0.0) recorder.output(run, engine.get());
    const auto keep = [&] {  // a run that goes on has the rows up to its checkpoint
        recorder.flush();
        write_checkpoint(arguments.folder, run.state(), engine.get());
    };
    Progress progress("run");
    int most_enclosed = 0;
    double end = fs::exists(arguments.folder / k_ends) ? std::stod(read_file(arguments.folder / k_ends)) : scene.end;
    double checkpoint_due = next_multiple(run.time(), scene.checkpoint_interval),
           output_due = next_multiple(run.time(), scene.write_interval);
    while (run.time() < end * (1.0 - 1e-12)) {
        run.step(std::min({output_due, checkpoint_due, end}) - run.time());
        const SceneReading reading = read_gauges(run, scene.pipe);
        recorder.step(run, reading, processor_seconds());
        if (run.last().enclosed_waters > most_enclosed) {
            most_enclosed = run.last().enclosed_waters;
            std::cout << "note: " << enclosed_note(most_enclosed, run.time()) << std::endl;
        }
        if (end > run.time() + scene.settle && stops(scene, reading)) {
            end = run.time() + scene.settle;
            write_file(arguments.folder / k_ends, fmt::format("{}\n", end));
        }
        if (run.time() >= output_due * (1.0 - 1e-12)) {
            recorder.output(run, engine.get());
            output_due = next_multiple(run.time(), scene.write_interval);
        }
        if (run.time() >= checkpoint_due * (1.0 - 1e-12)) {
            keep();
            checkpoint_due = next_multiple(run.time(), scene.checkpoint_interval);
        }
        if (is_asked_to_stop() && run.time() < end * (1.0 - 1e-12)) {
            keep();
            throw Interrupted(fmt::format("stopped on request at {:.9g} s", run.time()));
        }
        progress.update(run.time() / end, fmt::format("{:.4f} of {:g} s", run.time(), end));
    }
    keep();
    progress.finish(fmt::format("{:.1f} core s", processor_seconds()));
}

}  // namespace

int main(int argc, char** argv) {
    int code = static_cast<int>(ExitCode::done);
    MPI_Init(&argc, &argv);
    try {
        require_one_rank();
        const Arguments arguments = read_arguments(argc, argv);
        if (arguments.print_template) {
            std::cout << commented_toml(scene_table());
        } else {
            run_scene(arguments);
        }
    } catch (const Interrupted& stop) {
        std::cout << "cutterSurface: " << stop.what() << std::endl;
        code = static_cast<int>(ExitCode::interrupted);
    } catch (const Failure& failure) {
        std::cerr << "cutterSurface: " << failure.what() << std::endl;
        code = static_cast<int>(failure.code());
    } catch (const std::exception& error) {
        std::cerr << "cutterSurface: " << error.what() << std::endl;
        code = static_cast<int>(ExitCode::defect);
    }
    MPI_Finalize();
    return code;
}
