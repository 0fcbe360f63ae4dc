/* Properties of the schemes with one h a particle: what is conserved, the derivation from one
 * energy, the limit of the continuum. None of it uses the formulas of the operators. */
#include "../smoothed_help.h"

static sm_particles set, moved;
static double rate[3][3 * OC_MAX], gradv[9 * OC_MAX];
#define DRHO rate[0]
#define DVDT rate[1]
#define DEDT rate[2]

typedef struct world {
  sph_context *ctx;
  sph_kernel *kernel;
  sph_neighbors *list;
} world;

static world open_world(int32_t type, int32_t isa) {
  world w = {0};
  w.ctx = oc_context(isa, 1);
  w.kernel = oc_kernel(w.ctx, type, set.s.dim);
  set.kernel = moved.kernel = w.kernel;
  w.list = sm_list(w.ctx, &set);
  return w;
}

static void close_world(world *w) {
  sph_neighbors_destroy(w->list);
  sph_kernel_destroy(w->kernel);
  sph_context_destroy(w->ctx);
}

enum { VARY = OC_VARY_M | OC_VARY_H | OC_VARY_C };

/* --- conservation --------------------------------------------------------------------------- */

/* A sum that should vanish, in units of what is added up. */
typedef struct balance {
  double sum, size;
} balance;

static void add(balance *b, double term) {
  b->sum += term;
  b->size += fabs(term);
}
static void expect_zero(const balance *b, const char *what) {
  if (!(fabs(b->sum) <= 2e-14 * b->size))
    fail_msg("%s, %d-D: %g of %g", what, (int)set.s.dim, b->sum, b->size);
  assert_true(b->size > 0.0);
}

static void expect_momentum(const char *what) {
  for (int a = 0; a < set.s.dim; a++) {
    balance b = {0.0, 0.0};
    for (int64_t i = 0; i < set.s.n; i++) add(&b, set.s.m[i] * DVDT[i * set.s.dim + a]);
    expect_zero(&b, what);
  }
}

static void expect_angular_momentum(const char *what) {
  const int64_t d = set.s.dim;
  for (int a = 0; a < d; a++)
    for (int c = 0; c < a; c++) {
      balance b = {0.0, 0.0};
      for (int64_t i = 0; i < set.s.n; i++) {
        const double *x = set.s.x + i * d, *f = DVDT + i * d;
        add(&b, set.s.m[i] * x[a] * f[c]);
        add(&b, -set.s.m[i] * x[c] * f[a]);
      }
      expect_zero(&b, what);
    }
}

/* sum m (v.a + de/dt). */
static void expect_energy(const char *what) {
  balance b = {0.0, 0.0};
  for (int64_t i = 0; i < set.s.n; i++) {
    for (int a = 0; a < set.s.dim; a++)
      add(&b, set.s.m[i] * set.s.v[i * set.s.dim + a] * DVDT[i * set.s.dim + a]);
    add(&b, set.s.m[i] * DEDT[i]);
  }
  expect_zero(&b, what);
}

static const int32_t tried[] = {SPH_KERNEL_GAUSSIAN, SPH_KERNEL_WENDLAND_C4, SPH_KERNEL_LUCY};

static void test_pressure_conserves(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int k = 0; k < 3; k++)
      for (int32_t smoothing = 1; smoothing <= 3; smoothing++) {
        sm_make(&set, dim, VARY, k == 0 ? 3.0 : k == 1 ? 2.0 : 1.0, (uint64_t)(dim + 5 * k));
        world w = open_world(tried[k], SPH_ISA_AUTO);
        sph_operands a;
        sm_operands(&set, &a);
        check_ok(sph_smoothed_pressure(w.list, w.kernel, &a, smoothing, DRHO, DVDT, DEDT));
        expect_momentum("pressure: momentum");
        expect_angular_momentum("pressure: angular momentum");
        expect_energy("pressure: energy");
        close_world(&w);
      }
}

static void test_deviator_conserves(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++) {
    sm_make(&set, dim, VARY, 3.0, 4);
    world w = open_world(SPH_KERNEL_GAUSSIAN, SPH_ISA_AUTO);
    sph_operands a;
    sm_operands(&set, &a);
    check_ok(sph_smoothed_stress(w.list, w.kernel, &a, DVDT, DEDT, gradv));
    expect_momentum("deviator: momentum");
    expect_energy("deviator: energy");
    close_world(&w);
  }
}

static sph_dissipation only(double viscosity, double conductivity, double mass_flux) {
  sph_dissipation z;
  sph_dissipation_init(&z);
  z.viscosity = viscosity;
  z.conductivity = conductivity;
  z.mass_flux = mass_flux;
  z.flux_limit = 0.0;
  return z;
}

/* Each part conserves what it should, whatever the choices. */
static void test_dissipation_conserves(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int choice = 0; choice < 16; choice++) {
      sph_dissipation z = only(1.0, 0.0, 0.7);
      sph_operands a;
      sm_make(&set, dim, VARY, 3.0, (uint64_t)(dim + 3));
      world w = open_world(SPH_KERNEL_GAUSSIAN, SPH_ISA_AUTO);
      z.signal = 1 + (choice & 1);
      z.pairs = 1 + (choice >> 1 & 1);
      z.conductivity_form = 1 + (choice >> 2 & 1);
      z.flux_form = 1 + (choice >> 3 & 1);
      sm_operands(&set, &a);
      check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, DRHO, DVDT, DEDT));
      expect_momentum("viscosity: momentum");
      expect_angular_momentum("viscosity: angular momentum");
      expect_energy("viscosity: energy");
      balance flux = {0.0, 0.0};
      for (int64_t i = 0; i < set.s.n; i++) {
        add(&flux, set.s.m[i] * DRHO[i]);
        assert_true(DEDT[i] >= 0.0); /* heating */
      }
      expect_zero(&flux, "mass flux: sum m rho");
      z = only(0.0, 0.3, 0.0);
      z.signal = 1 + (choice & 1);
      z.pairs = 1 + (choice >> 1 & 1);
      z.conductivity_form = 1 + (choice >> 2 & 1);
      check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, DRHO, DVDT, DEDT));
      balance heat = {0.0, 0.0};
      double square = 0.0;
      for (int64_t i = 0; i < set.s.n; i++) {
        add(&heat, set.s.m[i] * DEDT[i]);
        square += set.s.m[i] * set.e[i] * DEDT[i];
        assert_true(DRHO[i] == 0.0 && DVDT[i * dim] == 0.0);
      }
      expect_zero(&heat, "conduction: energy");
      assert_true(square < 0.0); /* from hot to cold */
      close_world(&w);
    }
}

/* The flux evens out pressures, and the cut is where it should be. */
static void test_mass_flux(void **state) {
  (void)state;
  static double cut[OC_MAX];
  int clipped = 0, free_ones = 0;
  double even = 0.0;
  sm_make(&set, 2, VARY, 3.0, 8);
  world w = open_world(SPH_KERNEL_GAUSSIAN, SPH_ISA_AUTO);
  sph_dissipation z = only(0.0, 0.0, 1.0);
  sph_operands a;
  sm_operands(&set, &a);
  z.pairs = SPH_PAIRS_ALL;
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, DRHO, NULL, NULL));
  z.flux_limit = 0.05;
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, cut, NULL, NULL));
  for (int64_t i = 0; i < set.s.n; i++) {
    double most = 0.05 * set.s.rho[i] * set.s.c[i] / set.s.h[i];
    even += set.s.m[i] * set.s.p[i] * DRHO[i];
    if (fabs(DRHO[i]) > most)
      clipped++, assert_true(cut[i] == copysign(most, DRHO[i]));
    else
      free_ones++, assert_true(cut[i] == DRHO[i]);
  }
  assert_true(even < 0.0);
  assert_true(clipped > 0 && free_ones > 0);
  /* all in tension: nothing flows in the positive form */
  for (int64_t i = 0; i < set.s.n; i++) set.s.p[i] = -1.0 - set.e[i];
  z = only(0.0, 0.0, 1.0);
  z.flux_form = SPH_FLUX_POSITIVE;
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, cut, NULL, NULL));
  for (int64_t i = 0; i < set.s.n; i++) assert_true(cut[i] == 0.0);
  close_world(&w);
}

/* --- one energy ------------------------------------------------------------------------------ */

/* h and rho of a particle that satisfy h = eta (m / rho)^(1/d) and the density sum: the root of a
 * monotone function, by bisection. */
static double coupled_density(const sm_particles *p, int32_t smoothing, int64_t i, double eta,
                              double *h) {
  const int d = p->s.dim;
  double lo = 1e-3, hi = 20.0, rho = 0.0;
  for (int k = 0; k < 60; k++) {
    *h = 0.5 * (lo + hi);
    rho = 0.0;
    for (int64_t j = 0; j < p->s.n; j++)
      rho += p->s.m[smoothing == SPH_SMOOTHING_MASS ? j : i] *
             sph_kernel_w(p->kernel, sm_make_pair(p, i, j).r, *h);
    *(pow(*h, d) * rho < pow(eta, d) * p->s.m[i] ? &lo : &hi) = *h;
  }
  return rho;
}

enum { EXPONENT_TIMES_2 = 3 }; /* P = rho^1.5 */
static double pressure_of(double rho) { return pow(rho, 0.5 * EXPONENT_TIMES_2); }
static double energy_of(double rho) {
  return pow(rho, 0.5 * EXPONENT_TIMES_2 - 1.0) / (0.5 * EXPONENT_TIMES_2 - 1.0);
}

static const double eta_of[4] = {0.0, 1.7, 1.5, 1.3};

/* Coupled h and rho of all, and P; the list is built for them. */
static world open_coupled(int32_t dim, int32_t smoothing, uint64_t seed) {
  sm_make(&set, dim, OC_VARY_M, 2.0, seed);
  set.s.n = dim == 1 ? 20 : dim == 2 ? 36 : 64; /* the first ones of the lattice */
  world w = open_world(SPH_KERNEL_WENDLAND_C6, SPH_ISA_AUTO);
  for (int64_t i = 0; i < set.s.n; i++) {
    set.s.rho[i] = coupled_density(&set, smoothing, i, eta_of[dim], &set.s.h[i]);
    set.s.p[i] = pressure_of(set.s.rho[i]);
  }
  sph_neighbors_destroy(w.list);
  w.list = sm_list(w.ctx, &set);
  return w;
}

static double total_energy(const sm_particles *p, int32_t smoothing) {
  double sum = 0.0, h;
  for (int64_t i = 0; i < p->s.n; i++)
    sum += p->s.m[i] * energy_of(coupled_density(p, smoothing, i, eta_of[p->s.dim], &h));
  return sum;
}

/* With the operator's omega, the force is minus the gradient of sum m e(rho), h and rho following
 * each other, and the rate is the derivative of rho along the motion. */
static void check_potential(int32_t dim, int32_t smoothing) {
  world w = open_coupled(dim, smoothing, (uint64_t)(7 * dim + smoothing));
  const double step = 1e-4;
  sph_operands a;
  sm_operands(&set, &a);
  check_ok(sph_grad_h(w.list, w.kernel, &a, smoothing, 0.0, set.omega));
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &a, smoothing, DRHO, DVDT, DEDT));
  memcpy(&moved, &set, sizeof moved);
  double most = 0.0, h;
  for (int64_t k = 0; k < set.s.n * dim; k++) most = fmax(most, fabs(DVDT[k] * set.s.m[k / dim]));
  for (int64_t k = 0; k < set.s.n * dim; k += dim == 3 ? 17 : 5) {
    double side[2];
    for (int s = 0; s < 2; s++) {
      moved.s.x[k] = set.s.x[k] + (s ? step : -step);
      side[s] = total_energy(&moved, smoothing);
    }
    moved.s.x[k] = set.s.x[k];
    double force = -(side[1] - side[0]) / (2.0 * step);
    assert_true(fabs(force - set.s.m[k / dim] * DVDT[k]) <= 2e-6 * most);
  }
  for (int64_t i = 0; i < set.s.n; i++) {
    double side[2];
    for (int s = 0; s < 2; s++) {
      for (int64_t k = 0; k < set.s.n * dim; k++)
        moved.s.x[k] = set.s.x[k] + (s ? step : -step) * set.s.v[k];
      side[s] = coupled_density(&moved, smoothing, i, eta_of[dim], &h);
    }
    assert_true(fabs((side[1] - side[0]) / (2.0 * step) - DRHO[i]) <= 1e-6 * (1.0 + fabs(DRHO[i])));
  }
  close_world(&w);
}

static void test_potential(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= (check_short_run ? 2 : 3); dim++) {
    check_potential(dim, SPH_SMOOTHING_MASS);
    check_potential(dim, SPH_SMOOTHING_NUMBER);
  }
}

/* omega is the derivative of the density by h: rho_i of the sum at h_i (1 +- step). VOLUME: of sum
 * V_j W, which is a density whose masses are the volumes. */
static void test_omega(void **state) {
  (void)state;
  const double step = 1e-4;
  for (int32_t dim = 1; dim <= 3; dim++)
    for (int32_t smoothing = 1; smoothing <= 3; smoothing++) {
      const int volume = smoothing == SPH_SMOOTHING_VOLUME;
      double side[2][OC_MAX];
      sph_operands a;
      sm_make(&set, dim, VARY, 2.0, (uint64_t)(dim + 11));
      for (int s = 0; s < 2; s++) {
        memcpy(&moved, &set, sizeof moved);
        for (int64_t i = 0; i < set.s.n; i++) {
          moved.s.h[i] *= 1.0 + (s ? step : -step);
          if (volume) moved.s.m[i] /= set.s.rho[i];
        }
        world w = open_world(SPH_KERNEL_WENDLAND_C4, SPH_ISA_AUTO);
        sph_neighbors *list = sm_list(w.ctx, &moved);
        sm_operands(&moved, &a);
        check_ok(sph_smoothed_density(list, w.kernel, &a, volume ? SPH_SMOOTHING_MASS : smoothing,
                                      side[s]));
        sph_neighbors_destroy(list);
        close_world(&w);
      }
      world w = open_world(SPH_KERNEL_WENDLAND_C4, SPH_ISA_AUTO);
      sm_operands(&set, &a);
      check_ok(sph_grad_h(w.list, w.kernel, &a, smoothing, 0.0, DRHO));
      for (int64_t i = 0; i < set.s.n; i++) {
        double slope = (side[1][i] - side[0][i]) / (2.0 * step * set.s.h[i]);
        double want = 1.0 + set.s.h[i] / (dim * (volume ? 1.0 : set.s.rho[i])) * slope;
        assert_true(fabs(DRHO[i] - want) <= 1e-5 * (1.0 + fabs(want)));
      }
      close_world(&w);
    }
}

/* --- the continuum -----------------------------------------------------------------------------
 */

/* A periodic lattice of spacing 1 / side, h in spacings, density and speed of sound 1. */
static world open_lattice(int32_t dim, int64_t side, int32_t type, double h) {
  const double dp = 1.0 / (double)side;
  memset(&set, 0, sizeof set);
  set.s.dim = dim;
  set.s.n = dim == 1 ? side : dim == 2 ? side * side : side * side * side;
  set.s.flavour = OC_WRAP_ALL;
  set.s.edge = 1.0;
  for (int64_t i = 0; i < set.s.n; i++) {
    for (int64_t a = 0, k = i; a < dim; a++, k /= side)
      set.s.x[i * dim + a] = ((double)(k % side) + 0.5) * dp;
    set.s.m[i] = pow(dp, dim);
    set.s.rho[i] = set.s.c[i] = set.omega[i] = 1.0;
    set.s.h[i] = h * dp;
  }
  return open_world(type, SPH_ISA_AUTO);
}

static double wave(double x) { return sin(6.283185307179586 * x); }
static double wave_slope(double x) { return 6.283185307179586 * cos(6.283185307179586 * x); }

/* Largest errors of acceleration and of the rate of density on a lattice; exact: -P', -v'. */
static void errors(int32_t dim, int64_t side, int32_t smoothing, double *force,
                   double *divergence) {
  world w = open_lattice(dim, side, SPH_KERNEL_WENDLAND_C6, 3.0);
  sph_operands a;
  *force = *divergence = 0.0;
  for (int64_t i = 0; i < set.s.n; i++) {
    set.s.p[i] = 1.0 + 0.5 * wave(set.s.x[i * dim]);
    set.s.v[i * dim] = wave(set.s.x[i * dim]);
  }
  sm_operands(&set, &a);
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &a, smoothing, DRHO, DVDT, DEDT));
  for (int64_t i = 0; i < set.s.n; i++) {
    double slope = wave_slope(set.s.x[i * dim]);
    *force = fmax(*force, fabs(DVDT[i * dim] + 0.5 * slope));
    *divergence = fmax(*divergence, fabs(DRHO[i] + slope));
  }
  close_world(&w);
}

static void test_order(void **state) {
  (void)state;
  for (int32_t dim = 1; dim <= 2; dim++)
    for (int32_t smoothing = 1; smoothing <= 3; smoothing++) {
      double f[2], g[2];
      errors(dim, 24, smoothing, &f[0], &g[0]);
      errors(dim, 48, smoothing, &f[1], &g[1]);
      double of_force = log2(f[0] / f[1]), of_divergence = log2(g[0] / g[1]);
      assert_true(of_force > 1.9 && of_force < 2.1);
      assert_true(of_divergence > 1.9 && of_divergence < 2.1);
    }
}

/* e diffuses with a s h k: k = .564, .665, .752, for the Gaussian; e = x^2 has the Laplacian 2. */
static void test_diffusivity(void **state) {
  (void)state;
  static const double k[4] = {0.0, 0.564, 0.665, 0.752};
  for (int32_t dim = 1; dim <= 3; dim++) {
    const int64_t side = dim == 3 ? 17 : 41;
    const double h = 1.6; /* in spacings: the sums are close to integrals then */
    world w = open_lattice(dim, side, SPH_KERNEL_GAUSSIAN, h);
    sph_dissipation z = only(0.0, 0.8, 0.0);
    sph_operands a;
    int64_t middle = set.s.n / 2;
    z.pairs = SPH_PAIRS_ALL;
    for (int64_t i = 0; i < set.s.n; i++) {
      double x = set.s.x[i * dim] - set.s.x[middle * dim];
      set.e[i] = x * x;
      set.s.c[i] = 3.0;
    }
    sm_operands(&set, &a);
    check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, NULL, NULL, DEDT));
    double want = 2.0 * 0.8 * 3.0 * h / (double)side * k[dim];
    assert_true(fabs(DEDT[middle] - want) <= 0.02 * want);
    close_world(&w);
  }
}

/* --- by hand ------------------------------------------------------------------------------------
 */

/* Two particles on a line, kernel 1 - q^2 with h_1 = 2, h_2 = 1 apart by 1/2: W = (3/4)/h w, dW/dr
 * =
 * -(3/2) r / h^3: at h_1 -3/32, at h_2 -3/4. */
static void test_two_particles(void **state) {
  (void)state;
  static const double x[2] = {0.0, 0.5}, v[2] = {1.0, 0.0}, m[2] = {2.0, 1.0}, rho[2] = {4.0, 0.5};
  static const double h[2] = {2.0, 1.0}, p[2] = {8.0, 1.0}, c[2] = {1.0, 3.0}, e[2] = {2.0, 1.0};
  static const double tau[2] = {4.0, 2.0};
  memset(&set, 0, sizeof set);
  set.s.dim = 1;
  world w = open_world(SPH_KERNEL_QUADRATIC, SPH_ISA_AUTO);
  sph_operands a;
  sph_dissipation z = only(1.0, 0.5, 1.0);
  double drho[2], dvdt[2], dedt[2], L[2];
  sph_operands_init(&a);
  a.dim = 1;
  a.n = 2;
  a.x = x, a.v = v, a.m = m, a.rho = rho, a.h = h, a.p = p, a.c = c, a.e = e, a.sigma = tau;
  check_ok(sph_neighbors_build_arrays(w.list, 1, 2, x, h, 0.0));
  /* r_12 = -1, u = -1. V = 1/2, 2. */
  check_ok(sph_smoothed_density(w.list, w.kernel, &a, SPH_SMOOTHING_MASS, drho));
  check_close(drho[0], 2.0 * 3.0 / 8.0 + 1.0 * 3.0 / 8.0 * (15.0 / 16.0), 1e-15);
  check_close(drho[1], 1.0 * 3.0 / 4.0 + 2.0 * 3.0 / 4.0 * (3.0 / 4.0), 1e-15);
  check_ok(sph_smoothed_density(w.list, w.kernel, &a, SPH_SMOOTHING_NUMBER, drho));
  check_close(drho[0], 2.0 * (3.0 / 8.0 + 3.0 / 8.0 * (15.0 / 16.0)), 1e-15);
  /* v_12.r_12 = -1 times dW/dr */
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &a, SPH_SMOOTHING_MASS, drho, dvdt, dedt));
  check_close(drho[0], 1.0 * 3.0 / 32.0, 1e-15);
  check_close(drho[1], 2.0 * 3.0 / 4.0, 1e-15);
  check_close(dedt[0], 0.5 * 3.0 / 32.0, 1e-15);
  /* -m_2 (P/rho^2 = 1/2, 4) dW/dr r_12 */
  check_close(dvdt[0], -(0.5 * 3.0 / 32.0 + 4.0 * 3.0 / 4.0), 1e-15);
  check_close(dvdt[1], 2.0 * (0.5 * 3.0 / 32.0 + 4.0 * 3.0 / 4.0), 1e-15);
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &a, SPH_SMOOTHING_VOLUME, drho, dvdt, NULL));
  check_close(drho[0], 4.0 * 2.0 * 3.0 / 32.0, 1e-15);
  check_close(dvdt[0], -1.0 / 2.0 * (8.0 * 3.0 / 32.0 + 1.0 * 3.0 / 4.0), 1e-15);
  check_ok(sph_smoothed_pressure(w.list, w.kernel, &a, SPH_SMOOTHING_NUMBER, drho, dvdt, NULL));
  check_close(drho[0], 2.0 * 3.0 / 32.0, 1e-15);
  check_close(dvdt[0], -0.5 * (4.0 * 8.0 / 16.0 * 3.0 / 32.0 + 4.0 * 3.0 / 4.0), 1e-15);
  check_ok(sph_smoothed_stress(w.list, w.kernel, &a, dvdt, dedt, L));
  check_close(dvdt[0], 0.5 * (4.0 * 3.0 / 32.0 + 2.0 * 3.0 / 4.0), 1e-15);
  check_close(L[0], -2.0 * 3.0 / 32.0, 1e-15);
  check_close(dedt[0], 4.0 * L[0] / 4.0, 1e-15);
  /* rho_12 = 9/4, c_12 = 2, s = 2 + 1 = 3, mean slope -27/64 */
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, drho, dvdt, dedt));
  check_close(drho[0], 1.0 / 2.25 * 7.0 / 3.0 * -27.0 / 64.0, 1e-15);
  check_close(dvdt[0], 1.0 / 2.25 * 3.0 * -1.0 * (-27.0 / 64.0 * -1.0), 1e-15);
  check_close(dedt[0], -1.0 / 2.25 * (3.0 / 2.0 - 0.5 * 3.0 * 1.0) * -27.0 / 64.0, 1e-15);
  check_close(dedt[1], -2.0 / 2.25 * (3.0 / 2.0 + 0.5 * 3.0 * 1.0) * -27.0 / 64.0, 1e-15);
  z.signal = SPH_SIGNAL_GENERAL; /* sqrt(1 + 2) + sqrt(9 + 2) + 1 */
  check_ok(sph_smoothed_dissipation(w.list, w.kernel, &a, &z, NULL, dvdt, NULL));
  check_close(dvdt[0], -1.0 / 2.25 * (sqrt(3.0) + sqrt(11.0) + 1.0) * 27.0 / 64.0, 1e-15);
  close_world(&w);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(test_pressure_conserves),
                                          cmocka_unit_test(test_deviator_conserves),
                                          cmocka_unit_test(test_dissipation_conserves),
                                          cmocka_unit_test(test_mass_flux),
                                          cmocka_unit_test(test_potential),
                                          cmocka_unit_test(test_omega),
                                          cmocka_unit_test(test_order),
                                          cmocka_unit_test(test_diffusivity),
                                          cmocka_unit_test(test_two_particles)};
SPH_TEST_MAIN(tests)
