/* The settings and the size of one network: preset paper, 99 x 72 px, settings e985faff8db8.
 *
 * Written by `lobula export c` of lobula 0.1.0: do not edit, export again. Each macro is named after the setting's
 * path (`lobula config show` lists them); its comment says what it means, its unit, and in brackets where the value
 * comes from. Whole numbers, switches (0 or 1) and choices (counted from 0) are integers, all others floats. */
#ifndef LOBULA_CONFIG_H
#define LOBULA_CONFIG_H

#define LOBULA_VERSION "0.1.0"
#define LOBULA_PRESET "paper"
#define LOBULA_SETTINGS_HASH "e985faff8db8"
#define LOBULA_WIDTH 99
#define LOBULA_HEIGHT 72

#define LOBULA_CLOCK_PERIOD_MS 33.333333333333336f /* one tick, ms (paper Sec. III: 30 fps) */
#define LOBULA_CLOCK_CHANGE_EXPONENT 0.75f /* a step of n ticks counts its change n^-exponent times (calibrated on the synthetic battery, 15 against 30 Hz) */
#define LOBULA_CLOCK_MAX_GAP_MS 500.0f /* a longer silence starts the network afresh, ms (chosen) */
#define LOBULA_CLOCK_REPEATS 1 /* recognise frames that only repeat the one before (chosen) */
#define LOBULA_CLOCK_REPEAT_HOLD_MS 200.0f /* repeats longer than this are a still scene, ms (chosen) */
#define LOBULA_CLOCK_REPEAT_MEAN_GREY 0.1f /* mean change below which a frame repeats, grey (chosen) */
#define LOBULA_CLOCK_REPEAT_MAX_GREY 8.0f /* largest change below which a frame repeats, grey (chosen) */
#define LOBULA_FLASH_ENABLED 1 /* recognise global changes of light (chosen) */
#define LOBULA_FLASH_MIN_CHANGE_GREY 1.0f /* smallest mean change of the picture, grey (chosen) */
#define LOBULA_FLASH_MIN_COVERAGE 0.8f /* share of the pixels that brighten, or darken, together (chosen) */
#define LOBULA_FLASH_TRIM 3.0f /* pixels that change more than this many mean changes are left out of the fit (chosen) */
#define LOBULA_FLASH_MIN_EXPLAINED 0.7f /* share of the new picture's variance that the old one explains, noise aside (chosen) */
#define LOBULA_FLASH_MIN_GAIN 0.2f /* smallest gain a lamp or exposure step has (chosen) */
#define LOBULA_FLASH_MAX_GAIN 5.0f /* largest gain (chosen) */
#define LOBULA_SATURATION_ENABLED 0 /* limit the change that goes on to the lamina and the LGMDs (chosen) */
#define LOBULA_SATURATION_LIMIT_GREY 50.0f /* largest change that goes on, grey (chosen) */
#define LOBULA_COARSE_PATCH_PX 9 /* side of a patch, px (chosen) */
#define LOBULA_COARSE_FLOOR_GREY 1.0f /* mean change that a patch takes for noise, grey (chosen) */
#define LOBULA_LAMINA_DOG_ENABLED 1 /* off: the change goes on unfiltered (ablation) (paper Sec. II-B) */
#define LOBULA_LAMINA_DOG_RADIUS_PX 2 /* half width of the inner kernel, 5 x 5, px (published code: LGMDs.cs) */
#define LOBULA_LAMINA_DOG_SIGMA_PX 2.0f /* sigma of the inner field, px (published code: LGMDs.cs) */
#define LOBULA_LAMINA_DOG_SURROUND 2 /* size of the outer field, in inner ones (paper Sec. II-B) */
#define LOBULA_LAMINA_DOG_DEAD_ZONE_GREY 0.0001f /* inner responses below this are zero, grey (chosen: rounding noise has no sign) */
#define LOBULA_LAMINA_ON_OFF_RESIDUAL 0.1f /* share of the channel's previous value kept per clock tick (published code: LGMD2-open-source) */
#define LOBULA_LAMINA_FDSR_ENABLED 1 /* off: the channel goes on unadapted (ablation) (paper Sec. II-B) */
#define LOBULA_LAMINA_FDSR_RISE_MS 1.0f /* time constant of rises, ms (re-implementation: Drosmot) */
#define LOBULA_LGMD1_READS 1 /* lamina; the layer that excites it: the retina's change or the lamina's adapted channels (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD1_ON_CENTRE_WEIGHT 1.0f /* W at the cell itself (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_NEAREST_WEIGHT 0.25f /* W at each of the 4 nearest cells (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_DIAGONAL_WEIGHT 0.125f /* W at each of the 4 diagonal cells (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_CENTRE_MS 60.0f /* delay of the centre, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_NEAREST_MS 120.0f /* delay of the nearest cells, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_DIAGONAL_MS 180.0f /* delay of the diagonal cells, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_BIAS 0.5f /* w at rest (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_CENTRE_WEIGHT 1.0f /* W at the cell itself (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_NEAREST_WEIGHT 0.25f /* W at each of the 4 nearest cells (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_DIAGONAL_WEIGHT 0.125f /* W at each of the 4 diagonal cells (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_CENTRE_MS 60.0f /* delay of the centre, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_NEAREST_MS 120.0f /* delay of the nearest cells, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_DIAGONAL_MS 180.0f /* delay of the diagonal cells, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_BIAS 0.5f /* w at rest (published code: NewLGMDs) */
#define LOBULA_LGMD1_NEIGHBOUR_PX 1 /* distance of the neighbours in the 3 x 3 kernels, px (chosen) */
#define LOBULA_LGMD1_CHANGE_SCALE_GREY 20.0f /* mean change of the picture that raises the bias w to 1, grey (published code: NewLGMDs) */
#define LOBULA_LGMD1_CHANGE_MS 10.0f /* low-pass of that mean change, ms (published code: NewLGMDs) */
#define LOBULA_LGMD1_ON_GAIN 1.0f /* theta 1: weight of the ON branch (published code: NewLGMDs) */
#define LOBULA_LGMD1_OFF_GAIN 1.0f /* theta 2: weight of the OFF branch (published code: NewLGMDs) */
#define LOBULA_LGMD1_PRODUCT_GAIN 0.0f /* theta 3: weight of ON times OFF, 1/grey (published code: NewLGMDs) */
#define LOBULA_LGMD1_GROUPING_ENABLED 1 /* off: every cell counts as it is (ablation) (published code: LGMD2-open-source) */
#define LOBULA_LGMD1_GROUPING_THRESHOLD_GREY 0.1f /* grouped cells under this are dropped, grey (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD1_GROUPING_FLOOR_GREY 0.0001f /* keeps the normaliser off zero, grey (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD1_GROUPING_DIVISOR 4.0f /* share of the strongest neighbourhood in the normaliser (published code: LGMD2-open-source) */
#define LOBULA_LGMD1_COARSE_GAIN 0.0f /* weight of patches that darken, beside the grouped cells; 0: not heard (chosen) */
#define LOBULA_LGMD1_COARSE_ON_WEIGHT 5.0f /* patches that brighten are taken off so many times (chosen) */
#define LOBULA_LGMD1_SIGMOID_GREY 0.0048f /* C_sig: sum for each pixel that drives the sigmoid, grey (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD1_SFA_ENABLED 1 /* off: the potential is not adapted (ablation) (published code: LGMD2) */
#define LOBULA_LGMD1_SFA_TAU_MS 800.0f /* time constant of the fading, ms (published code: LGMD2) */
#define LOBULA_LGMD1_SFA_GROWTH 0.003f /* growth for each clock tick above which nothing fades, 1/tick (published code: LGMD2) */
#define LOBULA_LGMD1_SPIKING_GAIN 4.0f /* K_sp (paper Sec. III) */
#define LOBULA_LGMD1_SPIKING_THRESHOLD 0.7f /* T_sp, of the potential's magnitude (paper Sec. III) */
#define LOBULA_LGMD2_READS 1 /* lamina; the layer that excites it: the retina's change or the lamina's adapted channels (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD2_ON_CENTRE_WEIGHT 2.0f /* W at the cell itself (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_NEAREST_WEIGHT 0.5f /* W at each of the 4 nearest cells (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_DIAGONAL_WEIGHT 0.25f /* W at each of the 4 diagonal cells (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_CENTRE_MS 15.0f /* delay of the centre, ms (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_NEAREST_MS 30.0f /* delay of the nearest cells, ms (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_DIAGONAL_MS 45.0f /* delay of the diagonal cells, ms (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_BIAS 1.0f /* w at rest (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_OFF_CENTRE_WEIGHT 1.0f /* W at the cell itself (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_NEAREST_WEIGHT 0.25f /* W at each of the 4 nearest cells (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_DIAGONAL_WEIGHT 0.125f /* W at each of the 4 diagonal cells (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_CENTRE_MS 60.0f /* delay of the centre, ms (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_NEAREST_MS 120.0f /* delay of the nearest cells, ms (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_DIAGONAL_MS 180.0f /* delay of the diagonal cells, ms (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_BIAS 0.5f /* w at rest (published code: NewLGMDs) */
#define LOBULA_LGMD2_NEIGHBOUR_PX 1 /* distance of the neighbours in the 3 x 3 kernels, px (chosen) */
#define LOBULA_LGMD2_CHANGE_SCALE_GREY 20.0f /* mean change of the picture that raises the bias w to 1, grey (published code: NewLGMDs) */
#define LOBULA_LGMD2_CHANGE_MS 90.0f /* low-pass of that mean change, ms (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_ON_GAIN 1.0f /* theta 1: weight of the ON branch (published code: NewLGMDs) */
#define LOBULA_LGMD2_OFF_GAIN 1.0f /* theta 2: weight of the OFF branch (published code: NewLGMDs) */
#define LOBULA_LGMD2_PRODUCT_GAIN 1.0f /* theta 3: weight of ON times OFF, 1/grey (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_GROUPING_ENABLED 1 /* off: every cell counts as it is (ablation) (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_GROUPING_THRESHOLD_GREY 0.1f /* grouped cells under this are dropped, grey (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD2_GROUPING_FLOOR_GREY 0.0001f /* keeps the normaliser off zero, grey (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD2_GROUPING_DIVISOR 4.0f /* share of the strongest neighbourhood in the normaliser (published code: LGMD2-open-source) */
#define LOBULA_LGMD2_COARSE_GAIN 0.0f /* weight of patches that darken, beside the grouped cells; 0: not heard (chosen) */
#define LOBULA_LGMD2_COARSE_ON_WEIGHT 5.0f /* patches that brighten are taken off so many times (chosen) */
#define LOBULA_LGMD2_SIGMOID_GREY 0.0048f /* C_sig: sum for each pixel that drives the sigmoid, grey (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LGMD2_SFA_ENABLED 1 /* off: the potential is not adapted (ablation) (published code: LGMD2) */
#define LOBULA_LGMD2_SFA_TAU_MS 800.0f /* time constant of the fading, ms (published code: LGMD2) */
#define LOBULA_LGMD2_SFA_GROWTH 0.003f /* growth for each clock tick above which nothing fades, 1/tick (published code: LGMD2) */
#define LOBULA_LGMD2_SPIKING_GAIN 4.0f /* K_sp (paper Sec. III) */
#define LOBULA_LGMD2_SPIKING_THRESHOLD 0.7f /* T_sp, of the potential's magnitude (paper Sec. III) */
#define LOBULA_LPTC_EMD_SPANS 4 /* how many pairs of cells there are */
#define LOBULA_LPTC_EMD_WIDEST_PX 4 /* the largest distance, px */
#define LOBULA_LPTC_EMD_SPANS_PX {1, 2, 3, 4} /* distances of the paired cells, px (chosen: what passes a robot moves 1 to 3 px) */
#define LOBULA_LPTC_EMD_DELAYS_MS {40.0f, 30.0f, 20.0f, 10.0f} /* delay of each span, ms (published code: LPLC2) */
#define LOBULA_LPTC_SIGMOID_GREY2 0.002f /* K_hs: net motion for each pixel that drives the sigmoid, grey^2 (calibrated on the synthetic battery at 30 Hz (docs/calibration.md)) */
#define LOBULA_LPTC_SPIKING_GAIN 4.0f /* K_sp (paper Sec. III) */
#define LOBULA_LPTC_SPIKING_THRESHOLD 0.2f /* T_sp, of the potential's magnitude (paper Sec. III) */
#define LOBULA_DECISION_NEURONS 0 /* all; who decides: all four, the two LGMDs, or LGMD-2 alone (paper Sec. II-E) */
#define LOBULA_DECISION_WINDOW_MS 200.0f /* spikes are summed over this, ms (published code: NewLGMDs, 6 frames) */
#define LOBULA_DECISION_COLLISION_SPIKES 4 /* LGMD spikes in the window that make a collision (published code: robot) */
#define LOBULA_DECISION_LPTC_WEIGHT 1.0f /* weight of the LPTC spikes in the comparator (paper Alg. 1) */
#define LOBULA_DECISION_END_MS 200.0f /* a collision ends this long after the rule last held, ms (chosen) */
#define LOBULA_DECISION_WARM_UP_MS 200.0f /* no decision this long after a start, ms (chosen) */
#define LOBULA_DECISION_AFTER_TURN_MS 67.0f /* no decision this long after a turn, ms (chosen: two ticks) */

#endif
