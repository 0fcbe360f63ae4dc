/* 3x3 tensors in long double, for the tests of plasticity. */
#ifndef SPH_TESTS_TENSOR_HELP_H
#define SPH_TESTS_TENSOR_HELP_H

#include "check.h"

typedef long double real;
typedef real tensor[3][3];

static CHECK_UNUSED real equivalent(tensor s) {
  real mean = (s[0][0] + s[1][1] + s[2][2]) / 3, sum = 0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      real d = s[a][b] - (a == b ? mean : 0);
      sum += d * d;
    }
  return sqrtl(1.5L * sum);
}

static CHECK_UNUSED const int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
static CHECK_UNUSED const int packed[4][6] = {{0}, {0}, {0, 1, 3}, {0, 1, 2, 3, 4, 5}};

static CHECK_UNUSED void full(int32_t dim, const double *s, double across, tensor out) {
  memset(out, 0, sizeof(tensor));
  for (int k = 0; k < dim * (dim + 1) / 2; k++)
    out[row[packed[dim][k]]][column[packed[dim][k]]] =
        out[column[packed[dim][k]]][row[packed[dim][k]]] = s[k];
  for (int a = dim; a < 3; a++) out[a][a] = across;
}

#endif
