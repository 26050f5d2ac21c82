#include <algorithm>
#include <fstream>
#include <memory>
#include <string>

#include "geometry/base/file_content.hpp"
#include "solver/liggghts/tests/engine_fixture.hpp"

namespace cutterflow::liggghts::tests {

namespace {

/// Rocks that fall on a turning paddle, a plate and the floor, and on each other.
struct Mill {
    std::filesystem::path folder = scratch_folder();
    coupling::DemSettings settings = still_water();
    coupling::ZoneMotion rotor;

    Mill() {
        settings.domain.lower.z() = -0.1;
        settings.domain.make_wall(coupling::DomainSide::z_min);
        settings.walls = {{"paddle", write_stl(folder / "paddle.stl", block(Vec3(0.05, -0.01, -0.08), Vec3(0.3, 0.01, 0.05), 3)), true},
                          {"plate", write_stl(folder / "plate.stl", block(Vec3(-0.4, -0.1, -0.08), Vec3(-0.38, 0.1, 0.05), 2)), false}};
        rotor.speed = 6.0;
    }

    static coupling::Rocks heap() {
        coupling::Rocks rocks;
        for (int k = 0; k < 60; ++k)
            add_rock(rocks, 2 * k + 1, Vec3(-0.2 + 0.0205 * (k % 5), 0.05 + 0.0205 * (k / 5 % 4), -0.085 + 0.0205 * (k / 20)));
        add_rock(rocks, 200, Vec3(0.15, 0.05, -0.05));
        return rocks;
    }
};

Vec3 drag(std::size_t, const Vec3& velocity) {
    return Vec3(-0.1 * velocity);
}

double duration(int call) {
    return 2e-3 * (1.0 + 0.5 * std::sin(call));
}

double farthest(const coupling::Rocks& a, const coupling::Rocks& b) {
    EXPECT_EQ(a.id, b.id);
    double most = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, (a.position[k] - b.position[k]).norm());
    return most;
}

}  // namespace

TEST(Checkpoint, contact_free_rocks_go_on_as_if_never_stopped) {
    const auto folder = scratch_folder();
    const auto start = [](LiggghtsEngine& engine) {
        coupling::Rocks rocks;
        for (int k = 0; k < 8; ++k) add_rock(rocks, k + 1, Vec3(-0.2 + 0.05 * k, 0.02 * k, 0.3), Vec3(0.2, -0.1, 0.05 * k));
        engine.insert(rocks);
    };
    LiggghtsEngine through(still_water(), no_zones(), MPI_COMM_WORLD);
    start(through);
    for (int call = 0; call < 20; ++call) through.advance(duration(call), drag);

    LiggghtsEngine first(still_water(), no_zones(), MPI_COMM_WORLD);
    start(first);
    for (int call = 0; call < 10; ++call) first.advance(duration(call), drag);
    first.write_checkpoint(folder);
    LiggghtsEngine second(still_water(), no_zones(), MPI_COMM_WORLD);
    second.read_checkpoint(folder);
    EXPECT_LT(farthest(second.rocks(), first.rocks()), 1e-300);
    for (int call = 10; call < 20; ++call) second.advance(duration(call), drag);
    EXPECT_LT(farthest(second.rocks(), through.rocks()), 1e-12);
}

// With contacts: history, springs, impact speeds, contact forces and the rotor's position come back.
TEST(Checkpoint, lies_in_a_folder_with_a_long_path) {
    std::filesystem::path folder = scratch_folder();
    for (int part = 0; part < 8; ++part) folder /= std::string(120, static_cast<char>('a' + part));
    std::filesystem::create_directories(folder);
    LiggghtsEngine first(still_water(), no_zones(), MPI_COMM_WORLD);
    first.insert(one_rock(Vec3(0.1, 0, 0)));
    first.write_checkpoint(folder);
    LiggghtsEngine second(still_water(), no_zones(), MPI_COMM_WORLD);
    second.read_checkpoint(folder);
    EXPECT_EQ(second.rocks().id, first.rocks().id);
}

TEST(Checkpoint, rocks_in_contact_and_the_rotor_go_on_as_if_never_stopped) {
    const Mill mill;
    const int half = 60;
    LiggghtsEngine through(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    ASSERT_EQ(through.insert(Mill::heap()).size(), 61u);
    coupling::DemStep last_through;
    for (int call = 0; call < half + 3; ++call) last_through = through.advance(duration(call), drag);
    ASSERT_GT(last_through.contacts, 15);

    LiggghtsEngine first(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    first.insert(Mill::heap());
    for (int call = 0; call < half; ++call) first.advance(duration(call), drag);
    first.write_checkpoint(mill.folder);
    LiggghtsEngine second(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    second.read_checkpoint(mill.folder);
    EXPECT_NEAR(second.zone_angles().at(0), first.zone_angles().at(0), 1e-15);
    coupling::DemStep last_first, last_second;
    for (int call = half; call < half + 3; ++call) {
        last_first = first.advance(duration(call), drag);
        last_second = second.advance(duration(call), drag);
        EXPECT_NEAR(last_second.cutter_torque, last_first.cutter_torque, 1e-12);
    }
    EXPECT_LT(farthest(second.rocks(), through.rocks()), 1e-12);
    EXPECT_LT(farthest(first.rocks(), through.rocks()), 1e-12) << "writing a checkpoint must not disturb the run";
    EXPECT_NEAR(second.zone_angles().at(0), through.zone_angles().at(0), 1e-13);
    EXPECT_EQ(last_second.contacts, last_through.contacts);
    EXPECT_NEAR(last_second.cutter_torque, last_through.cutter_torque, 1e-9 * std::abs(last_through.cutter_torque));
}

// Nothing but steel touches the rock; the wall's angle is that of the time.
TEST(Checkpoint, a_rock_before_a_turning_wall_goes_on_to_the_bit) {
    const Mill mill;
    const auto start = [&] {
        auto engine = std::make_unique<LiggghtsEngine>(mill.settings, std::vector{mill.rotor}, MPI_COMM_WORLD);
        EXPECT_EQ(engine->insert(one_rock(Vec3(0.15, 0.03, -0.05))).size(), 1u);
        return engine;
    };
    const auto through = start(), first = start();
    for (int call = 0; call < 25; ++call) first->advance(duration(call), drag);
    first->write_checkpoint(mill.folder);
    LiggghtsEngine second(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    second.read_checkpoint(mill.folder);
    double torque = 0.0;
    for (int call = 0; call < 50; ++call) torque = std::min(torque, through->advance(duration(call), drag).cutter_torque);
    EXPECT_LT(torque, -0.01);
    for (int call = 25; call < 50; ++call) {
        first->advance(duration(call), drag);
        second.advance(duration(call), drag);
    }
    for (const auto* engine : {first.get(), &second}) {
        EXPECT_EQ(engine->rocks().position, through->rocks().position);
        EXPECT_EQ(engine->rocks().velocity, through->rocks().velocity);
        EXPECT_EQ(engine->rocks().angular_velocity, through->rocks().angular_velocity);
    }
}

TEST(Checkpoint, can_be_read_on_another_number_of_ranks) {
    const Mill mill;
    LiggghtsEngine all(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    all.insert(Mill::heap());
    for (int call = 0; call < 40; ++call) all.advance(duration(call), drag);
    all.write_checkpoint(mill.folder);
    LiggghtsEngine alone(mill.settings, {mill.rotor}, MPI_COMM_SELF);
    alone.read_checkpoint(mill.folder);
    EXPECT_LT(farthest(alone.rocks(), all.rocks()), 1e-300);
    for (int call = 40; call < 43; ++call) {
        all.advance(duration(call), drag);
        alone.advance(duration(call), drag);
    }
    EXPECT_LT(farthest(alone.rocks(), all.rocks()), 1e-11);
    EXPECT_NEAR(alone.zone_angles().at(0), all.zone_angles().at(0), 1e-12);
}

TEST(Checkpoint, a_folder_without_one_is_refused) {
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    EXPECT_THROW(engine.read_checkpoint(scratch_folder()), UserError);
}

TEST(Checkpoint, a_damaged_one_is_refused_as_the_users_input) {
    const auto folder = scratch_folder();
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    engine.write_checkpoint(folder);
    for (const char* text : {"", "{\"time_s\": 0.1", "{\"time_s\": 0.1}", "{\"time_s\": \"now\", \"torque_n_m\": 0}", "[]",
                             R"({"time_s": 0.1, "torque_n_m": 0.0, "contact_memory": 3, "walls": [{"name": "steel"}]})"}) {
        MPI_Barrier(MPI_COMM_WORLD);
        std::ofstream(folder / "dem.json") << text;
        MPI_Barrier(MPI_COMM_WORLD);
        EXPECT_THROW(engine.read_checkpoint(folder), UserError) << text;
    }
}

// LIGGGHTS would read an empty file for ever, and take changed bytes as they are.
TEST(Checkpoint, a_damaged_restart_file_is_refused) {
    const auto folder = scratch_folder();
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    engine.write_checkpoint(folder);
    const std::string whole = read_file(folder / "dem.restart");
    std::string changed = whole;
    changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] + 1);
    for (const std::string& content : {std::string(), whole.substr(0, whole.size() / 2), changed}) {
        MPI_Barrier(MPI_COMM_WORLD);
        std::ofstream(folder / "dem.restart", std::ios::binary) << content;
        MPI_Barrier(MPI_COMM_WORLD);
        try {
            engine.read_checkpoint(folder);
            ADD_FAILURE() << content.size() << " of " << whole.size() << " bytes";
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find("dem.restart"), std::string::npos) << error.what();
        }
    }
}

// Contacts of an earlier version remember the speeds of impacts where this one has radii.
TEST(Checkpoint, one_of_other_contact_memory_is_refused) {
    const auto folder = scratch_folder();
    LiggghtsEngine engine(still_water(), no_zones(), MPI_COMM_WORLD);
    engine.write_checkpoint(folder);
    MPI_Barrier(MPI_COMM_WORLD);
    std::ofstream(folder / "dem.json") << R"({"time_s": 0.1, "torque_n_m": 0.0})";
    MPI_Barrier(MPI_COMM_WORLD);
    try {
        engine.read_checkpoint(folder);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("contact_memory is 1"), std::string::npos) << error.what();
    }
}

TEST(Checkpoint, rock_can_be_inserted_and_removed_after_reading) {
    const Mill mill;
    LiggghtsEngine engine(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    engine.insert(Mill::heap());
    for (int call = 0; call < 5; ++call) engine.advance(duration(call), drag);
    engine.write_checkpoint(mill.folder);
    LiggghtsEngine resumed(mill.settings, {mill.rotor}, MPI_COMM_WORLD);
    resumed.read_checkpoint(mill.folder);
    coupling::Rocks more;
    add_rock(more, 300, Vec3(0, -0.3, 0.2), Vec3::Zero(), 0.03);
    EXPECT_EQ(resumed.insert(more), std::vector<int>{300});
    resumed.remove(std::vector<int>{1, 200});
    EXPECT_EQ(resumed.rocks().size(), 60u);
    const coupling::DemStep step = resumed.advance(2e-3, drag);
    EXPECT_EQ(step.impulse.size(), 60u);
    EXPECT_TRUE(step.left.id.empty());
}

}  // namespace cutterflow::liggghts::tests
