#include "solver/liggghts/contacts/models/rock_pair_model.hpp"
