/* The area average: means taken by hand, and the crops it refuses. */
#include "check.h"

static int close_to(float a, double b) { return a - b < 1e-3 && a - b > -1e-3; }

static void average(const lobula_resize_spec *spec, const lobula_images *source, float *out) {
    void *plan = memory(lobula_resize_size(spec));
    CHECK(lobula_resize_init(plan, spec, LOBULA_ISA_AUTO) == LOBULA_OK, "a crop inside the picture");
    CHECK(lobula_resize(plan, source, out) == LOBULA_OK, "a resize");
    free(plan);
}

/* 4 x 2 pixels to 2 x 1: (0 + 10 + 40 + 50) / 4 and (20 + 30 + 60 + 70) / 4. */
static void by_hand(void) {
    const uint8_t source[2][5] = {{0, 10, 20, 30, 99}, {40, 50, 60, 70, 99}};
    const lobula_images images = bytes_of(source[0], 5, 2);
    const lobula_resize_spec spec = {5, 2, 0, 0, 4, 2, 2, 1, 1.0, 0.0};
    const lobula_resize_spec thirds = {5, 2, 0, 0, 4, 1, 3, 1, 1.0, 0.0};
    float out[3];
    average(&spec, &images, out);
    CHECK(out[0] == 25.0f && out[1] == 45.0f, "whole blocks");
    average(&thirds, &images, out); /* 4/3 px each: (0 + 10/3) / (4/3), (2/3 10 + 2/3 20) / (4/3), (20/3 + 30) / (4/3) */
    CHECK(close_to(out[0], 2.5) && close_to(out[1], 15.0) && close_to(out[2], 27.5), "shares of pixels");
}

static double block_mean(const uint8_t *pixels, int row_bytes, int x, int y, int ratio_x, int ratio_y) {
    long sum = 0;
    for (int j = 0; j < ratio_y; j++)
        for (int i = 0; i < ratio_x; i++) sum += pixels[(y * ratio_y + j) * row_bytes + x * ratio_x + i];
    return (double)sum / (ratio_x * ratio_y);
}

/* Every whole ratio up to 7 x 7, of bytes and of floats, cut out of a larger picture. */
static void whole_ratios(void) {
    enum { OUT_W = 37, OUT_H = 5, LEFT = 3, TOP = 2, W = LEFT + 7 * OUT_W, H = TOP + 7 * OUT_H };
    static uint8_t bytes[H][W + 1];
    static float floats[H][W + 1], out[OUT_H * OUT_W];
    uint32_t draw = 7;
    for (int y = 0; y < H; y++)
        for (int x = 0; x <= W; x++) {
            draw = draw * 1664525u + 1013904223u;
            bytes[y][x] = (uint8_t)(draw >> 24);
            floats[y][x] = bytes[y][x];
        }
    for (int rx = 1; rx <= 7; rx++)
        for (int ry = 1; ry <= 7; ry++)
            for (int type = LOBULA_UINT8; type <= LOBULA_FLOAT32; type++) {
                lobula_resize_spec spec = {W, H, LEFT, TOP, rx * OUT_W, ry * OUT_H, OUT_W, OUT_H, 1.0, 0.0};
                lobula_images images = {type == LOBULA_UINT8 ? (void *)bytes : (void *)floats,
                                        type == LOBULA_UINT8 ? sizeof bytes[0] : sizeof floats[0], 0, type, 0};
                average(&spec, &images, out);
                for (int y = 0; y < OUT_H; y++)
                    for (int x = 0; x < OUT_W; x++)
                        CHECK(close_to(out[y * OUT_W + x], block_mean(&bytes[TOP][LEFT], W + 1, x, y, rx, ry)),
                              "the mean of a block");
            }
}

/* Limited range video, 16..235, becomes 0..255 and stays within. */
static void limited_range(void) {
    static const uint8_t source[2][4] = {{16, 235, 0, 255}, {16, 235, 0, 255}};
    const lobula_resize_spec spec = {4, 2, 0, 0, 4, 2, 4, 2, 255.0 / 219.0, -16.0 * 255.0 / 219.0};
    const lobula_images images = bytes_of(source[0], 4, 2);
    float out[8];
    average(&spec, &images, out);
    for (int i = 0; i < 8; i++) CHECK(close_to(out[i], i % 2 ? 255.0 : 0.0), "black and white of limited range");
}

static void refused(void) {
    const lobula_resize_spec bad[] = {
        {10, 10, 5, 5, 6, 5, 2, 2, 1.0, 0.0},  {10, 10, -1, 0, 5, 5, 2, 2, 1.0, 0.0},
        {10, 10, 0, 0, 0, 5, 2, 2, 1.0, 0.0},  {10, 10, 0, 0, 5, 5, 0, 2, 1.0, 0.0},
        {0, 10, 0, 0, 5, 5, 2, 2, 1.0, 0.0},   {10, 10, 2147483647, 0, 5, 5, 2, 2, 1.0, 0.0},
        {10, 10, 0, 0, 2147483647, 5, 2, 2, 1.0, 0.0}};
    static char plan[64];
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK(lobula_resize_size(&bad[i]) == 0, "no such crop");
        CHECK(lobula_resize_init(plan, &bad[i], LOBULA_ISA_AUTO) == LOBULA_BAD_ARGUMENT, "no such crop");
    }
}

int main(void) {
    by_hand();
    whole_ratios();
    limited_range();
    refused();
    puts("resize: good");
    return 0;
}
