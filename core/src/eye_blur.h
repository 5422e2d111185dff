/* Blur of the optics: a Gaussian cut at three standard deviations, the picture's rim repeated outwards. */
#ifndef LOBULA_EYE_BLUR_H
#define LOBULA_EYE_BLUR_H

#define EYE_MAX_BLUR 20.0

/* `columns` and `spare` hold width * height each. */
void eye_blur(float *columns, float *spare, int width, int height, double sd_px);

#endif
