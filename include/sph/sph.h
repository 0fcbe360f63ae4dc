/* libsph: everything. One header per subject; each can be included alone. */
#ifndef SPH_SPH_H
#define SPH_SPH_H

#include <sph/adapt.h>
#include <sph/base.h>
#include <sph/context.h>
#include <sph/correction.h>
#include <sph/elastodynamics.h>
#include <sph/integrator.h>
#include <sph/kernel.h>
#include <sph/material.h>
#include <sph/neighbors.h>
#include <sph/operators.h>
#include <sph/particles.h>
#include <sph/rhs.h>

#endif
