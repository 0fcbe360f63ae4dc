/* What this machine can give, whatever the program: flops in registers and bytes through memory, on
 * one thread and on several. Arguments: bench_args.h; case: machine. */
#include "bench.h"

#include "bench_args.h"
#include "bench_machine.h"

static void print_machine(const bench_machine *m) {
  double fma = m->flops[1] / m->flops[0], stream = m->bytes[1] / m->bytes[0];
  for (int k = 0; k < 2; k++)
    printf("BENCH case=machine isa=%s threads=%d peak_gflops=%.1f stream_gbytes_per_s=%.1f\n",
           sph_isa_name(m->isa), k == 0 ? 1 : (int)m->threads, m->flops[k] * 1e-9,
           m->bytes[k] * 1e-9);
  printf("BENCH case=machine isa=%s what=possible_with_%d_threads flops=%.2f stream=%.2f\n",
         sph_isa_name(m->isa), (int)m->threads, fma, stream);
  if (fma < 0.95 * m->threads)
    printf("# %d loops that touch registers only are %.2f times as fast as one: these processors "
           "share a core, or the machine has other work. No program gains more.\n",
           (int)m->threads, fma);
  fflush(stdout);
}

int main(int argc, char **argv) {
  bench_args args = bench_read_args(argc, argv);
  if (!bench_wants(&args, "machine")) return 0;
  for (int32_t isa = bench_best_isa(); isa >= SPH_ISA_PORTABLE; isa--) {
    if (isa != bench_best_isa() && !(args.longer && sph_isa_available(isa))) continue;
    bench_machine m = bench_machine_measure(isa, bench_threads(&args));
    print_machine(&m);
  }
  return 0;
}
