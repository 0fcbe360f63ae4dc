/* libsph: version, status codes and the conventions that every header uses.
 *
 * Conventions, fixed once here:
 *   - x_ij = x_i - x_j, v_ij = v_i - v_j.
 *   - h is the smoothing length; the support radius is sph_kernel_support(kernel) * h.
 *   - Stress is positive in tension, pressure in compression: sigma = S - p I.
 *   - Vector fields are particle-major: component a of particle i is f[i * dim + a].
 *   - Symmetric tensors are packed, sph_sym_components(dim) doubles a particle:
 *     1-D {xx}, 2-D {xx, yy, xy}, 3-D {xx, yy, zz, xy, xz, yz}.
 *   - Full tensors are row-major, dim*dim doubles: L[a * dim + b] = d v_a / d x_b.
 *   - No units are converted; any consistent system will do.
 *   - Outputs are untouched on failure unless the function says otherwise.
 *   - A NULL handle or a NULL required pointer is SPH_ERR_ARG. A handle of another kind is
 *     SPH_ERR_HANDLE. Both hold for every function and are not repeated. */
#ifndef SPH_BASE_H
#define SPH_BASE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(SPH_STATIC) || !defined(__GNUC__)
#define SPH_API
#else
#define SPH_API __attribute__((visibility("default")))
#endif

/* The one place where the version stands; Makefile and sph.pc read it here. */
#define SPH_VERSION_MAJOR 0
#define SPH_VERSION_MINOR 1
#define SPH_VERSION_PATCH 0

/* 0 is success, positive a request, negative a failure. Values never move. */
typedef int32_t sph_status;

#define SPH_STATUS_LIST(X)                                                 \
  X(SPH_OK, 0, "success")                                                  \
  X(SPH_RETRY, 1, "a smaller step is asked for")                           \
  X(SPH_ERR_ARG, -1, "invalid argument")                                   \
  X(SPH_ERR_NOMEM, -2, "out of memory")                                    \
  X(SPH_ERR_STALE, -3, "the neighbour list is older than the particles")   \
  X(SPH_ERR_VERSION, -4, "the options are newer than this library")        \
  X(SPH_ERR_CALLBACK, -5, "a host callback failed")                        \
  X(SPH_ERR_STATE, -6, "the call does not fit the state of the object")    \
  X(SPH_ERR_NUMERIC, -7, "a number is not finite or a system is singular") \
  X(SPH_ERR_UNSUPPORTED, -8, "this combination is not supported")          \
  X(SPH_ERR_LIMIT, -9, "a capacity or a counter would overflow")           \
  X(SPH_ERR_IO, -10, "reading or writing failed")                          \
  X(SPH_ERR_HANDLE, -11, "the handle is of another kind or was destroyed")

enum {
#define SPH_STATUS_ENUM(name, value, text) name = value,
  SPH_STATUS_LIST(SPH_STATUS_ENUM)
#undef SPH_STATUS_ENUM
      SPH_STATUS_RESERVED = -1000 /* keeps the list's last comma legal in C and C++ */
};

/* Static text of a status; never NULL, "unknown status" for other values. Since 0.1. */
SPH_API const char *sph_status_text(sph_status status);

/* Name of a status ("SPH_ERR_ARG"); never NULL, "unknown" for other values. Since 0.1. */
SPH_API const char *sph_status_name(sph_status status);

/* Version of the library that is running, as "0.1.0". Static. Since 0.1. */
SPH_API const char *sph_version_string(void);

/* Version of the running library as numbers; any pointer may be NULL. Since 0.1. */
SPH_API void sph_version(int32_t *major, int32_t *minor, int32_t *patch);

/* Components of a packed symmetric tensor: 1, 3, 6 for dim 1, 2, 3; 0 otherwise. Since 0.1. */
SPH_API int32_t sph_sym_components(int32_t dim);

/* Opaque handles, one header each. */
typedef struct sph_context sph_context;
typedef struct sph_particles sph_particles;
typedef struct sph_kernel sph_kernel;
typedef struct sph_neighbors sph_neighbors;
typedef struct sph_material sph_material;
typedef struct sph_rhs sph_rhs;
typedef struct sph_integrator sph_integrator;
typedef struct sph_total_lagrangian sph_total_lagrangian;

#ifdef __cplusplus
}
#endif
#endif
