#include "flash.h"

/* Variance that the noise of two pictures leaves between them, as model/retina.py. */
#define NOISE_GREY2 ((real)4.5)

int find_flash(const kernels *k, extent e, picture image, picture previous, const change_summary *about,
               const lobula_flash_params *p, change_of_light *light) {
    if (p->enabled == 0 || real_abs(about->mean) < p->min_change_grey) return 0;
    int32_t brighter, darker;
    k->coverage(e, image, previous, &brighter, &darker);
    real together = (real)(brighter > darker ? brighter : darker) / ((real)e.width * (real)e.height);
    if (together < p->min_coverage) return 0;

    real limit = p->trim * about->mean_abs;
    light_sums s = k->light(e, image, previous, limit);
    if (s.count == 0) return 0; /* trim 1, and a change that is everywhere the same but for rounding */
    real new_mean = s.new_sum / s.count, old_mean = s.old_sum / s.count;
    real variance = s.old_old / s.count - old_mean * old_mean;
    real covariance = s.new_old / s.count - new_mean * old_mean;
    light->gain = variance > NOISE_GREY2 ? covariance / variance : 1;
    light->offset = new_mean - light->gain * old_mean;
    if (light->gain < p->min_gain || light->gain > p->max_gain) return 0;
    real rest = k->light_rest(e, image, previous, limit, light->gain, light->offset);
    real new_variance = (s.change_change + 2 * s.new_old - s.old_old) / s.count - new_mean * new_mean;
    return rest / s.count <= (1 - p->min_explained) * new_variance + NOISE_GREY2;
}
