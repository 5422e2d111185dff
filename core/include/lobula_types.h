/* What the laptop's and the robot's lobula.h have in common: settings, readings, and the numbers of a state. */
#ifndef LOBULA_TYPES_H
#define LOBULA_TYPES_H

#include <stdint.h>

/* Numbers of which a step has a few, not one a pixel: double on a laptop, which says so by LOBULA_LAPTOP; float on a
 * robot, whose processor counts in nothing larger. Times are always double. */
#if defined(LOBULA_LAPTOP)
typedef double lobula_real;
#else
typedef float lobula_real;
#endif

/* Alignment of a state and of a workspace, bytes. */
#if defined(LOBULA_LAPTOP)
#define LOBULA_ALIGN 64
#else
#define LOBULA_ALIGN 8
#endif

#define LOBULA_ABI 3 /* changes when anything in this file or in lobula.h does */

#define LOBULA_MIN_WIDTH 32
#define LOBULA_MIN_HEIGHT 24
#define LOBULA_MAX_SIDE 32768
#define LOBULA_MAX_SPANS 8

/* What a call returns: 0, or the reason why nothing was done. */
enum {
    LOBULA_OK = 0,
    LOBULA_BAD_ARGUMENT = -1, /* a null pointer, a size or a setting that cannot be */
    LOBULA_BAD_STATE = -2     /* not a state of lobula_init, or of another ABI */
};

enum { LOBULA_UINT8 = 0, LOBULA_FLOAT32 = 1 };

/* How the planes of a state are kept: as floats; or the luma as bytes and all else as 16-bit floats, as on a robot.
 * A compact network takes pictures of bytes only. */
enum { LOBULA_FLOAT = 0, LOBULA_COMPACT = 1, LOBULA_STORAGES };

/* ---- Settings: the fields, names and units of the Python package, which documents each of them. -------------- */
/* Numbers are all of one type: switches are 0 or 1, choices count from 0 in the order of the comment. */

typedef struct {
    lobula_real period_ms, change_exponent, max_gap_ms, repeats, repeat_hold_ms, repeat_mean_grey, repeat_max_grey;
} lobula_clock_params;

typedef struct {
    lobula_real enabled, min_change_grey, min_coverage, trim, min_explained, min_gain, max_gain;
} lobula_flash_params;

typedef struct {
    lobula_real enabled, limit_grey;
} lobula_saturation_params;

typedef struct {
    lobula_real patch_px, floor_grey;
} lobula_coarse_params;

typedef struct {
    lobula_real enabled, radius_px, sigma_px, surround, dead_zone_grey;
} lobula_dog_params;

typedef struct {
    lobula_real residual;
} lobula_on_off_params;

typedef struct {
    lobula_real enabled, rise_ms;
} lobula_fdsr_params;

typedef struct {
    lobula_dog_params dog;
    lobula_on_off_params on_off;
    lobula_fdsr_params fdsr;
} lobula_lamina_params;

typedef struct {
    lobula_real centre_weight, nearest_weight, diagonal_weight, centre_ms, nearest_ms, diagonal_ms, bias;
} lobula_inhibition_params;

typedef struct {
    lobula_real enabled, threshold_grey, floor_grey, divisor;
} lobula_grouping_params;

typedef struct {
    lobula_real enabled, tau_ms, growth;
} lobula_sfa_params;

typedef struct {
    lobula_real gain, threshold;
} lobula_spiking_params;

typedef struct {
    lobula_real reads; /* change, lamina */
    lobula_inhibition_params on, off;
    lobula_real neighbour_px, change_scale_grey, change_ms, on_gain, off_gain, product_gain;
    lobula_grouping_params grouping;
    lobula_real coarse_gain, coarse_on_weight;
    lobula_real sigmoid_grey;
    lobula_sfa_params sfa;
    lobula_spiking_params spiking;
} lobula_lgmd_params;

typedef struct {
    lobula_real spans; /* how many of the pairs below are in use */
    lobula_real spans_px[LOBULA_MAX_SPANS], delays_ms[LOBULA_MAX_SPANS];
} lobula_emd_params;

typedef struct {
    lobula_emd_params emd;
    lobula_real sigmoid_grey2;
    lobula_spiking_params spiking;
} lobula_lptc_params;

typedef struct {
    lobula_real neurons; /* all, lgmds, lgmd2 */
    lobula_real window_ms, collision_spikes, lptc_weight, end_ms, warm_up_ms, after_turn_ms;
} lobula_decision_params;

typedef struct {
    lobula_clock_params clock;
    lobula_flash_params flash;
    lobula_saturation_params saturation;
    lobula_coarse_params coarse;
    lobula_lamina_params lamina;
    lobula_lgmd_params lgmd1, lgmd2;
    lobula_lptc_params lptc;
    lobula_decision_params decision;
} lobula_params;

/* ---- What comes out. ------------------------------------------------------------------------------------------ */

enum { LOBULA_STATE_OK, LOBULA_STATE_WARMING_UP, LOBULA_STATE_STALE, LOBULA_STATE_FLASH, LOBULA_STATE_TURNING };

typedef struct {
    double time_s;
    lobula_real lgmd1, lgmd2;   /* membrane potentials in [0.5, 1) */
    lobula_real lptc_r, lptc_l; /* in [0, 1) and (-1, 0] */
    int32_t spikes[4];          /* lgmd1, lgmd2, lptc_r, lptc_l */
    int32_t collision;          /* 0 or 1 */
    int32_t state;              /* LOBULA_STATE_... */
} lobula_reading;

/* Maps of a step, each (height, width) float32, given as an array of pointers in this order; NULL: not wanted. */
enum {
    LOBULA_TAP_CHANGE, LOBULA_TAP_LAMINA, LOBULA_TAP_ADAPTED_ON, LOBULA_TAP_ADAPTED_OFF, LOBULA_TAP_MOTION,
    LOBULA_TAP_LGMD1_INHIBITION_ON, LOBULA_TAP_LGMD1_INHIBITION_OFF, LOBULA_TAP_LGMD1_SUMMATION,
    LOBULA_TAP_LGMD1_GROUPED,
    LOBULA_TAP_LGMD2_INHIBITION_ON, LOBULA_TAP_LGMD2_INHIBITION_OFF, LOBULA_TAP_LGMD2_SUMMATION,
    LOBULA_TAP_LGMD2_GROUPED,
    LOBULA_TAPS
};

/* ---- What is remembered beside the planes. --------------------------------------------------------------------- */

typedef struct {
    lobula_real raw, potential, change_before;
} lobula_lgmd_scalars;

typedef struct {
    double time_s;
    lobula_real lgmd1, lgmd2, lptc;
} lobula_decision_entry;

/* A time that was never set is told by its has_ flag. */
typedef struct {
    double frame_s, tick_s, step_s, started_s, turned_s, held_s;
    int32_t has_frame, has_turned, has_held;
    int32_t still, flashing;
    lobula_lgmd_scalars lgmd1, lgmd2;
    lobula_real rightward, leftward;
} lobula_scalars;

#endif
