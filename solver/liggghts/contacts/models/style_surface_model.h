#include "surface_model_default.h"
