/* From luminance to bytes: noise, rounding, and rows instead of columns. Whole numbers only, so that every instruction
 * set and the NumPy reference give the same. */
#ifndef LOBULA_EYE_SENSOR_H
#define LOBULA_EYE_SENSOR_H

#include <stdint.h>

/* A grey level counts 128 here. */
#define EYE_GREY_BITS 7
#define EYE_GREY (1 << EYE_GREY_BITS)
/* Noise is a sum of four bytes less its mean, with a standard deviation of sqrt(4 (256^2 - 1) / 12); times `scale` over
 * 2^EYE_SCALE_BITS it is in 1/128 grey. */
#define EYE_BYTES_MEAN 510
#define EYE_BYTES_SD 147.80054127099805
#define EYE_SCALE_BITS 14

typedef struct {
    uint32_t first, second; /* the key, mixed */
    int32_t scale;          /* 0: no noise */
} eye_noise;

typedef struct {
    /* `columns` (width, height) to `rows` (height, width); `bytes` holds width * height */
    void (*sense)(const float *columns, int width, int height, eye_noise noise, uint8_t *bytes, uint8_t *rows);
} eye_kernels;

#endif
