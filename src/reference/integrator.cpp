// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/integrator.h"

namespace gloam::reference {}
