// A host program in C++11: handles owned by unique_ptr, callbacks as lambdas, vectors lent to the
// particle set. It runs an elastic wave in a bar, with the library's law and with its own.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <sph/sph.h>

namespace {

template <typename T, void (*Destroy)(T *)> struct Deleter {
  void operator()(T *handle) const { Destroy(handle); }
};
template <typename T, void (*Destroy)(T *)> using Handle = std::unique_ptr<T, Deleter<T, Destroy>>;

using Context = Handle<sph_context, sph_context_destroy>;
using Particles = Handle<sph_particles, sph_particles_destroy>;
using Kernel = Handle<sph_kernel, sph_kernel_destroy>;
using Neighbors = Handle<sph_neighbors, sph_neighbors_destroy>;
using Material = Handle<sph_material, sph_material_destroy>;
using Rhs = Handle<sph_rhs, sph_rhs_destroy>;
using Integrator = Handle<sph_integrator, sph_integrator_destroy>;

void require(bool holds, const char *what) {
  if (!holds) throw std::runtime_error(what);
}

void ok(sph_status status, const sph_context *ctx) {
  if (status != SPH_OK)
    throw std::runtime_error(std::string(sph_status_name(status)) + ": " +
                             (ctx ? sph_context_last_error(ctx) : sph_status_text(status)));
}

// Own memory hooks that count.
struct Counter {
  long live = 0;
};

Context make_context(Counter &counter) {
  sph_context_options o;
  sph_context *ctx = nullptr;
  sph_context_options_init(&o);
  o.alloc_user = &counter;
  o.alloc = [](void *user, size_t size, size_t) -> void * {
    ++static_cast<Counter *>(user)->live;
    // room to align by hand, with the original address before the block
    unsigned char *raw = static_cast<unsigned char *>(::operator new(size + 64 + sizeof(void *)));
    std::uintptr_t at = reinterpret_cast<std::uintptr_t>(raw) + sizeof(void *);
    unsigned char *block = raw + sizeof(void *) + (64 - at % 64) % 64;
    reinterpret_cast<void **>(block)[-1] = raw;
    return block;
  };
  o.free = [](void *user, void *ptr, size_t) {
    if (!ptr) return;
    --static_cast<Counter *>(user)->live;
    ::operator delete(static_cast<void **>(ptr)[-1]);
  };
  ok(sph_context_create(&o, &ctx), nullptr);
  return Context(ctx);
}

const int count = 100;
const double spacing = 1.0 / count;

// The bar's fields, the host's own.
struct Bar {
  std::vector<double> x, v, m, rho, h, sigma;
  Bar()
      : x(count), v(count), m(count, spacing), rho(count, 1.0), h(count, 1.5 * spacing),
        sigma(count) {
    for (int i = 0; i < count; ++i) {
      const double y = ((i + 0.5) * spacing - 0.5) / 0.1;
      x[static_cast<size_t>(i)] = (i + 0.5) * spacing;
      v[static_cast<size_t>(i)] = 1e-3 * std::exp(-y * y);
      sigma[static_cast<size_t>(i)] = -v[static_cast<size_t>(i)];
    }
  }
  void lend(sph_particles *set, const sph_context *ctx) {
    std::vector<std::pair<int32_t, std::vector<double> *>> fields = {
        {SPH_FIELD_X, &x},     {SPH_FIELD_V, &v}, {SPH_FIELD_M, &m},
        {SPH_FIELD_RHO, &rho}, {SPH_FIELD_H, &h}, {SPH_FIELD_SIGMA, &sigma}};
    for (auto &field : fields)
      ok(sph_particles_lend(set, field.first, field.second->data(), count), ctx);
  }
};

Material own_law(sph_context *ctx, double &young) {
  sph_material_functions f;
  sph_material *m = nullptr;
  sph_material_functions_init(&f);
  f.stress_rate = [](void *user, const sph_material_block *b, double *rate) -> int32_t {
    for (int64_t i = 0; i < b->n; ++i)
      rate[i] = *static_cast<double *>(user) * b->velocity_gradient[i];
    return 0;
  };
  ok(sph_material_create(ctx, &f, &young, &m), ctx);
  return Material(m);
}

Material library_law(sph_context *ctx) {
  sph_hooke_options o;
  sph_material *m = nullptr;
  sph_hooke_options_init(&o);
  o.young = o.density = 1.0;
  ok(sph_material_create_hooke(ctx, &o, &m), ctx);
  return Material(m);
}

Rhs make_rhs(sph_context *ctx, sph_kernel *kernel, sph_material *law) {
  sph_rhs *rhs = nullptr;
  ok(sph_rhs_create(ctx, kernel, nullptr, &rhs), ctx);
  Rhs owned(rhs);
  for (int32_t kind : {SPH_TERM_STRESS, SPH_TERM_STRESS_RATE}) {
    sph_term term;
    sph_term_init(&term);
    term.kind = kind;
    if (kind == SPH_TERM_STRESS) term.form = SPH_STRESS_DIFFERENCE;
    ok(sph_rhs_add(rhs, &term), ctx);
  }
  ok(sph_rhs_set_material(rhs, 0, law), ctx);
  return owned;
}

Integrator make_integrator(sph_context *ctx) {
  sph_integrator_options o;
  sph_integrator *it = nullptr;
  sph_integrator_options_init(&o);
  o.method = SPH_INTEGRATOR_RK4;
  ok(sph_integrator_create(ctx, &o, &it), ctx);
  ok(sph_integrator_bind_field(it, SPH_FIELD_V), ctx);
  ok(sph_integrator_bind_field(it, SPH_FIELD_SIGMA), ctx);
  return Integrator(it);
}

// Everything of a run; members go in reverse order, the context's reference first of all.
std::vector<double> run(const std::function<Material(sph_context *)> &law) {
  Counter counter;
  Bar bar;
  {
    Context ctx = make_context(counter);
    sph_particles_options po;
    sph_particles *set = nullptr;
    sph_kernel *kernel = nullptr;
    sph_neighbors *list = nullptr;
    sph_particles_options_init(&po);
    po.dim = 1;
    ok(sph_particles_create(ctx.get(), &po, &set), ctx.get());
    Particles particles(set);
    bar.lend(set, ctx.get());
    ok(sph_particles_add(set, count, nullptr), ctx.get());
    ok(sph_kernel_create(ctx.get(), SPH_KERNEL_CUBIC_SPLINE, 1, &kernel), ctx.get());
    Kernel owned_kernel(kernel);
    ok(sph_neighbors_create(ctx.get(), nullptr, &list), ctx.get());
    Neighbors owned_list(list);
    Material material = law(ctx.get());
    Rhs rhs = make_rhs(ctx.get(), kernel, material.get());
    Integrator it = make_integrator(ctx.get());
    ok(sph_integrator_set_rhs(it.get(), rhs.get(), list), ctx.get());
    const double dt = 0.5 * spacing;
    for (int k = 0; k < 30; ++k)
      ok(sph_integrator_step(it.get(), set, k * dt, dt, nullptr), ctx.get());
  }
  require(counter.live == 0, "memory is left");
  return bar.v;
}

void test_wave() {
  double young = 1.0, worst = 0.0;
  const std::vector<double> mine = run([&](sph_context *ctx) { return own_law(ctx, young); });
  const std::vector<double> theirs = run([](sph_context *ctx) { return library_law(ctx); });
  require(mine == theirs, "the host's law and the library's differ");
  for (int i = 0; i < count; ++i) {
    const double y = ((i + 0.5) * spacing - 0.5 - 30 * 0.5 * spacing) / 0.1;
    worst = std::fmax(worst, std::fabs(mine[static_cast<size_t>(i)] - 1e-3 * std::exp(-y * y)));
  }
  require(worst < 5e-5, "the pulse is not where it should be");
}

void test_errors() {
  Counter counter;
  Context ctx = make_context(counter);
  sph_kernel *kernel = nullptr;
  require(sph_kernel_create(ctx.get(), -3, 2, &kernel) == SPH_ERR_ARG, "an unknown kernel");
  require(sph_context_last_error(ctx.get())[0] != '\0', "no sentence");
  require(std::string(sph_version_string()) == std::to_string(SPH_VERSION_MAJOR) + "." +
                                                   std::to_string(SPH_VERSION_MINOR) + "." +
                                                   std::to_string(SPH_VERSION_PATCH),
          "header and library are of different versions");
}

} // namespace

int main() {
  int failed = 0;
  for (void (*test)() : {test_wave, test_errors}) {
    try {
      test();
    } catch (const std::exception &e) {
      std::fprintf(stderr, "%s\n", e.what());
      ++failed;
    }
  }
  std::printf("%d passed, %d failed\n", 2 - failed, failed);
  return failed != 0;
}
