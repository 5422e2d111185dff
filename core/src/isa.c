/* The instruction sets this build holds, the plainest first. A build for one machine has only `base`. */
#include "sweep.h"

extern const kernels kernels_base;
#ifdef LOBULA_WITH_V3
extern const kernels kernels_v3;
#endif
#ifdef LOBULA_WITH_V4
extern const kernels kernels_v4;
#endif

static const kernels *const built[] = {
    &kernels_base,
#ifdef LOBULA_WITH_V3
    &kernels_v3,
#endif
#ifdef LOBULA_WITH_V4
    &kernels_v4,
#endif
};

enum { BUILT = sizeof built / sizeof built[0] };

const kernels *kernels_of(int isa) { return isa >= 0 && isa < BUILT ? built[isa] : NULL; }

const char *lobula_isa_name(int isa) { return kernels_of(isa) ? kernels_of(isa)->name : NULL; }

int lobula_isa_runs(int isa) { return kernels_of(isa) && kernels_of(isa)->runs(); }

int lobula_isa_best(void) {
    int best = BUILT - 1;
    while (best > 0 && !built[best]->runs()) best--;
    return best;
}
