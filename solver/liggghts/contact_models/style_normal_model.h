#include "solver/liggghts/contact_models/rock_pair_model.hpp"
