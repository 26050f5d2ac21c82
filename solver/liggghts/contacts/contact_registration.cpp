#include "solver/liggghts/contacts/contact_registration.hpp"

// The order matters: pair_gran_base.h uses what these headers declare without including them.
// clang-format off
#include "lammps.h"
#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "modify.h"
#include "settings.h"
#include "fix_insert_stream.h"
#include "contact_models.h"
#include "pair_gran_base.h"
#include "fix_wall_gran.h"
#include "granular_wall.h"
// clang-format on

#include "solver/liggghts/contacts/contact_context.hpp"
#include "solver/liggghts/contacts/wall_contacts.hpp"

namespace cutterflow::liggghts {

namespace {

using namespace LIGGGHTS::ContactModels;
using RockStyle = GranStyle<ROCK_PAIR>;
using RockPair = LIGGGHTS::PairStyles::Granular<ContactModel<RockStyle>>;

/// Hands every touch of a plane that LIGGGHTS finds to WallContacts.
class PlaneWall final : public LIGGGHTS::Walls::IGranularWall {
public:
    PlaneWall(ContactContext& context, LAMMPS_NS::FixWallGran* owner) : context_(context), owner_(owner) {}

    void settings(int, char**, LIGGGHTS::IContactHistorySetup*) override {}
    void init_granular() override {}
    bool checkSurfaceIntersect(SurfacesIntersectData&) override { return true; }
    int get_history_offset(std::string) override { return -1; }
    bool contact_match(const std::string, const std::string) override { return false; }

    void compute_force(LAMMPS_NS::FixWallGran*, SurfacesIntersectData& found, bool touches, double*, LAMMPS_NS::FixMeshSurface*, int,
                       LAMMPS_NS::TriMesh*, int) override {
        if (!touches) return;
        WallTouch touch;
        touch.rock = found.i;
        touch.body = context_.planes.find(owner_->id)->second;
        touch.normal = Vec3(found.delta).normalized();
        touch.overlap = found.deltan;
        context_.wall_contacts->add(touch);
    }

private:
    ContactContext& context_;
    LAMMPS_NS::FixWallGran* owner_;
};

LIGGGHTS::PairStyles::IGranularPairStyle* create_pair(LAMMPS_NS::LAMMPS* lammps, LAMMPS_NS::PairGran* owner, std::int64_t hash) {
    return new RockPair(lammps, owner, hash);
}

LIGGGHTS::Walls::IGranularWall* create_wall(LAMMPS_NS::LAMMPS* lammps, LAMMPS_NS::FixWallGran* owner, std::int64_t) {
    return new PlaneWall(ContactContext::of(lammps), owner);
}

bool register_once() {
    Factory::instance().addNormalModel("rock", ROCK_PAIR);
    LIGGGHTS::PairStyles::Factory::instance().addStyle("gran", RockStyle::HASHCODE, &create_pair);
    LIGGGHTS::Walls::Factory::instance().addStyle("gran", RockStyle::HASHCODE, &create_wall);
    return true;
}

}  // namespace

void register_contact_models() {
    static const bool registered = register_once();
    (void)registered;
}

}  // namespace cutterflow::liggghts
