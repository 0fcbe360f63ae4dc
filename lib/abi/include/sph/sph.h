/* libsph: everything. One header per subject; each can be included alone. */
#ifndef SPH_SPH_H
#define SPH_SPH_H

#include <sph/adapt.h>
#include <sph/base.h>
#include <sph/boundary.h>
#include <sph/context.h>
#include <sph/correction.h>
#include <sph/elastic.h>
#include <sph/elastodynamics.h>
#include <sph/eos.h>
#include <sph/integrator.h>
#include <sph/io.h>
#include <sph/kernel.h>
#include <sph/layout.h>
#include <sph/material.h>
#include <sph/neighbors.h>
#include <sph/operators.h>
#include <sph/particles.h>
#include <sph/plasticity.h>
#include <sph/reference.h>
#include <sph/rhs.h>
#include <sph/shocks.h>
#include <sph/smoothing.h>
#include <sph/total_lagrangian.h>
#include <sph/stress.h>
#include <sph/stress_points.h>

#endif
