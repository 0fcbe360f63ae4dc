/* Loops over components, written out at compile time. */
#ifndef SPHI_UNROLL_H
#define SPHI_UNROLL_H

/* Indices must be constants before the compiler decides what lives in registers, or every vector
 * goes through memory. `dim` is a variable of the caller. */
#define WHEN(condition, name, value, ...) \
  if (condition) {                        \
    const int name = value;               \
    __VA_ARGS__;                          \
  }
#define EACH_DIM(a, ...)             \
  do {                               \
    WHEN(1, a, 0, __VA_ARGS__)       \
    WHEN(dim > 1, a, 1, __VA_ARGS__) \
    WHEN(dim > 2, a, 2, __VA_ARGS__) \
  } while (0)
#define EACH_SYM(c, ...)             \
  do {                               \
    WHEN(1, c, 0, __VA_ARGS__)       \
    WHEN(dim > 1, c, 1, __VA_ARGS__) \
    WHEN(dim > 1, c, 2, __VA_ARGS__) \
    WHEN(dim > 2, c, 3, __VA_ARGS__) \
    WHEN(dim > 2, c, 4, __VA_ARGS__) \
    WHEN(dim > 2, c, 5, __VA_ARGS__) \
  } while (0)
#define EACH_FIELD(c, ...)     \
  do {                         \
    WHEN(1, c, 0, __VA_ARGS__) \
    WHEN(1, c, 1, __VA_ARGS__) \
    WHEN(1, c, 2, __VA_ARGS__) \
    WHEN(1, c, 3, __VA_ARGS__) \
  } while (0)
#define EACH_QUAD(q, count, ...)           \
  do {                                     \
    WHEN(1, q, 0, __VA_ARGS__)             \
    WHEN((count) > 1, q, 1, __VA_ARGS__)   \
    WHEN((count) > 2, q, 2, __VA_ARGS__)   \
    WHEN((count) > 3, q, 3, __VA_ARGS__)   \
    WHEN((count) > 4, q, 4, __VA_ARGS__)   \
    WHEN((count) > 5, q, 5, __VA_ARGS__)   \
    WHEN((count) > 6, q, 6, __VA_ARGS__)   \
    WHEN((count) > 7, q, 7, __VA_ARGS__)   \
    WHEN((count) > 8, q, 8, __VA_ARGS__)   \
    WHEN((count) > 9, q, 9, __VA_ARGS__)   \
    WHEN((count) > 10, q, 10, __VA_ARGS__) \
    WHEN((count) > 11, q, 11, __VA_ARGS__) \
  } while (0)

#endif
