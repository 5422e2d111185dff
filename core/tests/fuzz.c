/* One random life of a network and one random resize, drawn from a few bytes: for a fuzzer, or for fuzz_main.c.
 *
 * The sanitizers watch the memory, which is exactly as large as the core asked for. What is checked besides: the
 * readings stay in their ranges, and a second network that takes the same frames in blocks, or goes on from a saved
 * state, says the same. */
#include "check.h"

#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Draws come from the bytes while there are any, then from a generator that they have seeded. */
typedef struct {
    const uint8_t *data;
    size_t left;
    uint64_t state;
} dice;

static uint32_t draw(dice *d) {
    uint32_t mixed;
    d->state = d->state * 6364136223846793005u + 1442695040888963407u;
    mixed = (uint32_t)(d->state >> 33);
    if (d->left) {
        mixed += *d->data * 2654435761u;
        d->state ^= *d->data++;
        d->left--;
    }
    return mixed & 0x7fffffffu;
}

static int below(dice *d, int n) { return (int)(draw(d) % (uint32_t)n); }

static int one_in(dice *d, int n) { return below(d, n) == 0; }

static double between(dice *d, double low, double high) {
    int edge = below(d, 12);
    return edge == 0 ? low : edge == 1 ? high : low + (high - low) * (draw(d) / 2147483647.0);
}

static void maybe(dice *d, double *value, double low, double high) {
    if (one_in(d, 2)) *value = between(d, low, high);
}

static void maybe_whole(dice *d, double *value, int low, int high) {
    if (one_in(d, 3)) *value = low + below(d, high - low + 1);
}

static void draw_lgmd(dice *d, lobula_lgmd_params *p) {
    lobula_inhibition_params *rings[2] = {&p->on, &p->off};
    for (int c = 0; c < 2; c++) {
        lobula_inhibition_params *r = rings[c];
        maybe(d, &r->centre_weight, 0, 8);
        maybe(d, &r->nearest_weight, 0, 4);
        maybe(d, &r->diagonal_weight, 0, 4);
        maybe(d, &r->centre_ms, 1, 1000);
        maybe(d, &r->nearest_ms, 1, 1000);
        maybe(d, &r->diagonal_ms, 1, 1000);
        maybe(d, &r->bias, 0, 8);
    }
    maybe_whole(d, &p->reads, 0, 1);
    maybe_whole(d, &p->neighbour_px, 1, one_in(d, 4) ? 32 : 3);
    maybe(d, &p->change_scale_grey, 0.1, 1000);
    maybe(d, &p->change_ms, 0.1, 1000);
    maybe(d, &p->on_gain, 0, 8);
    maybe(d, &p->off_gain, 0, 8);
    maybe(d, &p->product_gain, 0, 8);
    maybe_whole(d, &p->grouping.enabled, 0, 1);
    maybe(d, &p->grouping.threshold_grey, 0, 255);
    maybe(d, &p->grouping.floor_grey, 1e-6, 10);
    maybe(d, &p->grouping.divisor, 0.1, 100);
    maybe(d, &p->coarse_gain, 0, 100);
    maybe(d, &p->coarse_on_weight, 0, 100);
    maybe(d, &p->sigmoid_grey, 1e-6, 100);
    maybe_whole(d, &p->sfa.enabled, 0, 1);
    maybe(d, &p->sfa.tau_ms, 10, 10000);
    maybe(d, &p->spiking.gain, 0.1, 20);
    maybe(d, &p->spiking.threshold, 0, 1);
}

/* Half the LGMDs are alike in all but the ON channel, as in the presets: the core has a short way for those. */
static lobula_params draw_params(dice *d) {
    lobula_params p = published();
    maybe(d, &p.clock.period_ms, 5, 200);
    maybe(d, &p.clock.change_exponent, 0, 1);
    maybe(d, &p.clock.max_gap_ms, 100, 10000);
    maybe_whole(d, &p.clock.repeats, 0, 1);
    maybe(d, &p.clock.repeat_hold_ms, 0, 2000);
    maybe_whole(d, &p.flash.enabled, 0, 1);
    maybe(d, &p.flash.min_coverage, 0.5, 1);
    maybe(d, &p.flash.trim, 1, 100);
    maybe(d, &p.flash.min_explained, 0, 1);
    maybe_whole(d, &p.saturation.enabled, 0, 1);
    maybe(d, &p.saturation.limit_grey, 1, 255);
    maybe_whole(d, &p.coarse.patch_px, 1, one_in(d, 4) ? 256 : 12);
    maybe(d, &p.coarse.floor_grey, 0, one_in(d, 4) ? 255 : 4);
    maybe_whole(d, &p.lamina.dog.enabled, 0, 1);
    maybe_whole(d, &p.lamina.dog.radius_px, 1, one_in(d, 4) ? 32 : 4);
    maybe_whole(d, &p.lamina.dog.surround, 2, 4);
    maybe(d, &p.lamina.dog.sigma_px, 0.3, 32);
    maybe(d, &p.lamina.dog.dead_zone_grey, 0, 1);
    maybe(d, &p.lamina.on_off.residual, 0, 0.9);
    maybe_whole(d, &p.lamina.fdsr.enabled, 0, 1);
    maybe(d, &p.lamina.fdsr.rise_ms, 0.1, 100);
    if (one_in(d, 2)) {
        draw_lgmd(d, &p.lgmd1);
        draw_lgmd(d, &p.lgmd2);
    } else {
        p.lgmd1.reads = p.lgmd2.reads = below(d, 2);
        p.lgmd1.neighbour_px = p.lgmd2.neighbour_px = 1 + below(d, 4);
        maybe(d, &p.lgmd2.coarse_gain, 0, 10);
    }
    maybe_whole(d, &p.lptc.emd.spans, 1, LOBULA_MAX_SPANS);
    for (int i = 0; i < (int)p.lptc.emd.spans; i++) {
        p.lptc.emd.spans_px[i] = 1 + below(d, one_in(d, 4) ? 64 : 6);
        p.lptc.emd.delays_ms[i] = between(d, 0.1, 500);
    }
    maybe(d, &p.lptc.sigmoid_grey2, 1e-6, 100);
    p.decision.neurons = below(d, 3);
    maybe(d, &p.decision.window_ms, 30, 1000);
    maybe_whole(d, &p.decision.collision_spikes, 1, 100);
    maybe(d, &p.decision.warm_up_ms, 0, 5000);
    return p;
}

enum { MOST_FRAMES = 7 };

typedef struct {
    lobula_images images;
    void *memory;
    int count;
    double times_s[MOST_FRAMES];
    uint8_t turning[MOST_FRAMES];
} film;

static double draw_pixel(dice *d, int kind, double low, double high) {
    uint32_t r = draw(d);
    switch (kind) {
    case 0: return low + (high - low) * (r / 2147483647.0); /* noise */
    case 1: return r % 2 ? 255 : 0;
    case 2: return r % 500 ? low : high; /* points */
    default: return low;
    }
}

/* Pictures that fill their memory to the last byte, upside down now and then. */
static film draw_film(dice *d, int width, int height, double after_s, int bytes_only) {
    film f = {.count = 1 + below(d, MOST_FRAMES)};
    size_t pixel = bytes_only || one_in(d, 2) ? 1 : sizeof(float);
    size_t row = ((size_t)width + (one_in(d, 2) ? (size_t)below(d, 20) : 0)) * pixel;
    size_t image = row * (size_t)(height - 1) + (size_t)width * pixel;
    size_t apart = image + pixel * (size_t)below(d, 3);
    int upside_down = one_in(d, 4);
    f.memory = memory(apart * (size_t)(f.count - 1) + image);
    char *first = f.memory;
    for (int t = 0; t < f.count; t++) {
        int kind = below(d, 4);
        double low = between(d, 0, 255), high = between(d, low, 255);
        if (t && one_in(d, 6)) {
            memcpy(first + (size_t)t * apart, first + (size_t)(t - 1) * apart, image); /* a repeat */
        } else {
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++) {
                    double value = draw_pixel(d, kind, low, high);
                    char *at = first + (size_t)t * apart + (size_t)y * row + (size_t)x * pixel;
                    float real = (float)value;
                    if (pixel == 1)
                        *(uint8_t *)at = (uint8_t)value;
                    else
                        memcpy(at, &real, sizeof real);
                }
        }
        int odd = below(d, 8);
        double interval_s = odd == 0 ? 1e-6 : odd == 1 ? between(d, 0.0, 20.0) : odd == 2 ? 1.0 / 120 : 1.0 / 30;
        after_s = f.times_s[t] = after_s + interval_s + 1e-9;
        f.turning[t] = (uint8_t)one_in(d, 8);
    }
    f.images.pixels = upside_down ? first + (size_t)(height - 1) * row : first;
    f.images.row_bytes = upside_down ? -(ptrdiff_t)row : (ptrdiff_t)row;
    f.images.image_bytes = (ptrdiff_t)apart;
    f.images.type = pixel == 1 ? LOBULA_UINT8 : LOBULA_FLOAT32;
    return f;
}

static void look_at(const lobula_reading *r) {
    CHECK(r->lgmd1 >= 0.5 && r->lgmd1 < 1.0, "LGMD-1 in [0.5, 1)");
    CHECK(r->lgmd2 >= 0.5 && r->lgmd2 < 1.0, "LGMD-2 in [0.5, 1)");
    CHECK(r->lptc_r >= 0.0 && r->lptc_r < 1.0, "LPTC-R in [0, 1)");
    CHECK(r->lptc_l > -1.0 && r->lptc_l <= 0.0, "LPTC-L in (-1, 0]");
    CHECK(r->lptc_r == 0.0 || r->lptc_l == 0.0, "one direction at a time");
    for (int i = 0; i < 4; i++) CHECK(r->spikes[i] >= 0, "spikes are counted");
    CHECK(r->collision == 0 || r->collision == 1, "collision or not");
    CHECK(r->state >= LOBULA_STATE_OK && r->state <= LOBULA_STATE_TURNING, "a state that has a name");
}

/* Save one network plane by plane and load it into another, made afresh. */
static void move_state(dice *d, const void *from, void *to, int width, int height) {
    size_t pixels = (size_t)width * (size_t)height;
    float *plane = memory(pixels * sizeof *plane);
    lobula_scalars scalars;
    int count = lobula_window_count(from), capacity = lobula_window_capacity(from);
    lobula_decision_entry *window = memory(((size_t)capacity + 1) * sizeof *window);
    for (int i = 0; i < LOBULA_PLANES; i++) {
        CHECK(lobula_get_plane(from, i, plane) == LOBULA_OK, "a plane out");
        CHECK(lobula_set_plane(to, i, plane) == LOBULA_OK, "a plane in");
    }
    CHECK(lobula_get_scalars(from, &scalars) == LOBULA_OK && lobula_set_scalars(to, &scalars) == LOBULA_OK, "numbers");
    CHECK(count >= 0 && count <= capacity, "the window holds what it can");
    CHECK(lobula_get_window(from, window) == LOBULA_OK, "a window out");
    if (one_in(d, 3)) /* one that is as full as it can be, and newer than any frame to come */
        for (count = 0; count < capacity; count++) {
            lobula_decision_entry crowded = {scalars.frame_s, 1.0, 1.0, 0.5};
            window[count] = crowded;
        }
    CHECK(lobula_set_window(to, window, count) == LOBULA_OK, "a window in");
    CHECK(lobula_set_window((void *)from, window, count) == LOBULA_OK, "a window in");
    CHECK(lobula_set_window(to, window, capacity + 1) == LOBULA_BAD_ARGUMENT, "a window that is too long");
    free(window);
    free(plane);
}

/* Step one network through the film, run the other through it in blocks. */
static void live(dice *d, const lobula_net *stepped, const lobula_net *run, int frames, const film *f, int width,
                 int height) {
    size_t pixels = (size_t)width * (size_t)height;
    lobula_reading one[MOST_FRAMES], many[MOST_FRAMES];
    float *maps[LOBULA_TAPS] = {NULL};
    int tapped = one_in(d, 3);
    for (int i = 0; tapped && i < LOBULA_TAPS; i++) maps[i] = one_in(d, 2) ? memory(pixels * sizeof(float)) : NULL;
    for (int t = 0; t < f->count; t++) {
        lobula_images image = f->images;
        image.pixels = (const char *)f->images.pixels + t * f->images.image_bytes;
        CHECK(lobula_in_range(&image, width, height), "pixels in 0..255");
        CHECK(lobula_step(stepped, &image, f->times_s[t], f->turning[t], &one[t], tapped ? maps : NULL) == LOBULA_OK,
              "a step");
        look_at(&one[t]);
        for (int i = 0; i < LOBULA_TAPS; i++)
            for (size_t at = 0; maps[i] && at < pixels; at++) CHECK(isfinite(maps[i][at]), "a map of numbers");
    }
    CHECK(lobula_run(run, &f->images, f->times_s, f->turning, f->count, frames, many) == LOBULA_OK, "a block");
    for (int t = 0; t < f->count; t++) {
        CHECK(memcmp(&one[t], &many[t], sizeof one[t]) == 0, "a block and its frames one by one");
        look_at(&many[t]);
    }
    for (int i = 0; i < LOBULA_TAPS; i++) free(maps[i]);
}

static void fuzz_network(dice *d) {
    lobula_params p = draw_params(d);
    int width = LOBULA_MIN_WIDTH + below(d, 109), height = LOBULA_MIN_HEIGHT + below(d, 87);
    int frames = 1 + below(d, 18), isa = 0;
    int storage = one_in(d, 3) ? LOBULA_COMPACT : LOBULA_FLOAT;
    lobula_net a = network_in(storage, &p, width, height, 1), b = network_in(storage, &p, width, height, frames);
    while (lobula_isa_name(isa + 1) && one_in(d, 2)) isa++;
    if (lobula_isa_runs(isa)) {
        CHECK(lobula_init(a.state, &p, width, height, storage, isa) == LOBULA_OK, "an instruction set that runs here");
        CHECK(lobula_init(b.state, &p, width, height, storage, isa) == LOBULA_OK, "an instruction set that runs here");
    }
    double now_s = between(d, -1.0, 1e6);
    for (int part = 1 + below(d, 3); part > 0; part--) {
        film f = draw_film(d, width, height, now_s, storage == LOBULA_COMPACT);
        live(d, &a, &b, frames, &f, width, height);
        now_s = f.times_s[f.count - 1];
        free(f.memory);
        if (one_in(d, 5)) {
            lobula_reset(a.state);
            lobula_reset(b.state);
        }
        move_state(d, a.state, b.state, width, height);
    }
    release(&a);
    release(&b);
}

static void fuzz_resize(dice *d) {
    lobula_resize_spec s = {.source_width = 1 + below(d, 160), .source_height = 1 + below(d, 120)};
    s.crop_x = below(d, s.source_width);
    s.crop_y = below(d, s.source_height);
    s.crop_width = 1 + below(d, s.source_width - s.crop_x);
    s.crop_height = 1 + below(d, s.source_height - s.crop_y);
    s.out_width = 1 + below(d, 140);
    s.out_height = 1 + below(d, 110);
    s.gain = one_in(d, 2) ? 1.0 : 255.0 / 219.0;
    s.offset = s.gain == 1.0 ? 0.0 : -16.0 * 255.0 / 219.0;
    film f = draw_film(d, s.source_width, s.source_height, 0.0, 0);
    size_t pixels = (size_t)s.out_width * (size_t)s.out_height;
    void *plan = memory(lobula_resize_size(&s));
    float *out = memory(pixels * sizeof *out);
    CHECK(lobula_resize_init(plan, &s, LOBULA_ISA_AUTO) == LOBULA_OK, "a crop inside the picture");
    CHECK(lobula_resize(plan, &f.images, out) == LOBULA_OK, "a resize");
    for (size_t i = 0; i < pixels; i++) CHECK(out[i] >= 0.0f && out[i] <= 255.0f, "a mean within 0..255");
    free(out);
    free(plan);
    free(f.memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    dice d = {data, size, 1};
    fuzz_network(&d);
    fuzz_resize(&d);
    return 0;
}
