/* The instruction sets this build holds, the plainest first. A build for one machine has only `base`. */
#include "lobula.h"
#include "sweep.h"

extern const kernels kernels_base, kernels_compact_base;
#ifdef LOBULA_WITH_V3
extern const kernels kernels_v3, kernels_compact_v3;
#endif
#ifdef LOBULA_WITH_V4
extern const kernels kernels_v4, kernels_compact_v4;
#endif

/* In the order of LOBULA_FLOAT and LOBULA_COMPACT. */
static const kernels *const built[][LOBULA_STORAGES] = {
    {&kernels_base, &kernels_compact_base},
#ifdef LOBULA_WITH_V3
    {&kernels_v3, &kernels_compact_v3},
#endif
#ifdef LOBULA_WITH_V4
    {&kernels_v4, &kernels_compact_v4},
#endif
};

enum { BUILT = sizeof built / sizeof built[0] };

const kernels *kernels_of(int isa, int storage) {
    return isa >= 0 && isa < BUILT && storage >= 0 && storage < LOBULA_STORAGES ? built[isa][storage] : NULL;
}

const char *lobula_isa_name(int isa) { return kernels_of(isa, LOBULA_FLOAT) ? kernels_of(isa, LOBULA_FLOAT)->name : NULL; }

int lobula_isa_runs(int isa) { return kernels_of(isa, LOBULA_FLOAT) && kernels_of(isa, LOBULA_FLOAT)->runs(); }

int lobula_isa_best(void) {
    int best = BUILT - 1;
    while (best > 0 && !lobula_isa_runs(best)) best--;
    return best;
}
