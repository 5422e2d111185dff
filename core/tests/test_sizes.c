/* Sizes, the ABI, and what a network refuses to be. */
#include "check.h"

#include <math.h>

static void abi(void) {
    CHECK(lobula_abi() == LOBULA_ABI, "the library belongs to its header");
    CHECK(lobula_params_size() == sizeof(lobula_params), "the settings are as large as the header says");
    CHECK(sizeof(lobula_reading) == 64, "5 doubles and 6 integers without gaps");
    CHECK(sizeof(lobula_decision_entry) == 32, "4 doubles");
}

static void instruction_sets(void) {
    int count = 0;
    while (lobula_isa_name(count)) count++;
    CHECK(lobula_isa_runs(0), "the plainest runs everywhere");
    CHECK(lobula_isa_runs(lobula_isa_best()) && lobula_isa_best() < count, "the best one runs here");
    CHECK(lobula_isa_name(-1) == NULL && !lobula_isa_runs(count) && !lobula_isa_runs(-1), "there are no others");
}

/* The usual picture fits a small processor: the promise of the README. */
static void state_is_small(void) {
    lobula_params p = published();
    size_t bytes = lobula_state_size(&p, 99, 72, LOBULA_FLOAT);
    CHECK(bytes > 0 && bytes <= 200 * 1024, "the state of a 99 x 72 network");
    p.lgmd1.reads = p.lgmd2.reads = 1;
    CHECK(lobula_state_size(&p, 99, 72, LOBULA_FLOAT) < bytes, "LGMDs that read the lamina need no planes of the change");
    CHECK(lobula_workspace_size(&p, 99, 72, LOBULA_FLOAT, 4) == 4 * lobula_workspace_size(&p, 99, 72, LOBULA_FLOAT, 1), "a frame at a time");
    CHECK(lobula_block_frames(&p, 99, 72, LOBULA_FLOAT) == 1, "the state fits the cache");
}

static void refused_size(int width, int height) {
    lobula_params p = published();
    static char state[64];
    CHECK(lobula_state_size(&p, width, height, LOBULA_FLOAT) == 0, "no such state");
    CHECK(lobula_workspace_size(&p, width, height, LOBULA_FLOAT, 1) == 0, "no such workspace");
    CHECK(lobula_init(state, &p, width, height, LOBULA_FLOAT, LOBULA_ISA_AUTO) == LOBULA_BAD_ARGUMENT, "no such network");
}

static void refused(lobula_params p, const char *what) {
    static char state[64];
    CHECK(lobula_state_size(&p, 99, 72, LOBULA_FLOAT) == 0, what);
    CHECK(lobula_init(state, &p, 99, 72, LOBULA_FLOAT, LOBULA_ISA_AUTO) == LOBULA_BAD_ARGUMENT, what);
}

static void refused_settings(void) {
    lobula_params p = published();
    p.lptc.emd.spans = LOBULA_MAX_SPANS + 1;
    refused(p, "more spans than there are places for");
    p = published();
    p.lptc.emd.spans_px[3] = 0;
    refused(p, "a span of no pixels");
    p = published();
    p.lamina.dog.radius_px = 33;
    refused(p, "a DoG of radius 33");
    p = published();
    p.lgmd1.neighbour_px = NAN;
    refused(p, "a distance that is no number");
    p = published();
    p.lgmd2.reads = 2;
    refused(p, "a layer that does not exist");
    p = published();
    p.coarse.patch_px = 0;
    refused(p, "patches of no pixels");
    p = published();
    p.coarse.patch_px = NAN;
    refused(p, "a side that is no number");
    p = published();
    p.clock.period_ms = 0;
    refused(p, "a clock that stands still");
    p = published();
    p.decision.window_ms = INFINITY;
    refused(p, "a window without end");
}

static void refused_calls(void) {
    lobula_params p = published();
    lobula_net net = network(&p, 32, 24, 1);
    static uint8_t pixels[32 * 24];
    lobula_images images = bytes_of(pixels, 32, 24);
    lobula_reading reading;
    CHECK(lobula_step(&net, &images, 0.0, 0, &reading, NULL) == LOBULA_OK, "the least picture there is");
    CHECK(lobula_step(&net, &images, 1.0, 0, NULL, NULL) == LOBULA_BAD_ARGUMENT, "nowhere to put the reading");
    CHECK(lobula_step(&net, NULL, 1.0, 0, &reading, NULL) == LOBULA_BAD_ARGUMENT, "no picture");
    images.type = 2;
    CHECK(lobula_step(&net, &images, 1.0, 0, &reading, NULL) == LOBULA_BAD_ARGUMENT, "no such type of pixels");
    CHECK(lobula_init(net.state, &p, 32, 24, LOBULA_FLOAT, 99) == LOBULA_BAD_ARGUMENT, "no such instruction set");
    CHECK(lobula_init(NULL, &p, 32, 24, LOBULA_FLOAT, 0) == LOBULA_BAD_ARGUMENT, "no state");
    memset(net.state, 0, 64);
    images.type = LOBULA_UINT8;
    CHECK(lobula_step(&net, &images, 1.0, 0, &reading, NULL) == LOBULA_BAD_STATE, "not a state");
    CHECK(lobula_reset(net.state) == LOBULA_BAD_STATE, "not a state");
    release(&net);
}

static void in_range(void) {
    static float pixels[24 * 37]; /* 33 columns: whole vectors, and one that is not */
    lobula_images image = {pixels, 37 * sizeof(float), 0, LOBULA_FLOAT32, 0};
    const float bad[] = {-0.01f, 255.1f, NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 24 * 37; i++) pixels[i] = i % 37 < 33 ? (float)(i % 256) : NAN; /* between rows: not looked at */
    CHECK(lobula_in_range(&image, 33, 24), "all within 0..255");
    for (int x = 0; x < 33; x++)
        for (int b = 0; b < 5; b++) {
            float *pixel = &pixels[(x % 24) * 37 + x], before = *pixel;
            *pixel = bad[b];
            CHECK(!lobula_in_range(&image, 33, 24), "one outside 0..255");
            *pixel = before;
        }
}

int main(void) {
    abi();
    instruction_sets();
    state_is_small();
    refused_size(31, 24);
    refused_size(32, 23);
    refused_size(0, 0);
    refused_size(-99, -72);
    refused_size(LOBULA_MAX_SIDE + 1, 72);
    refused_settings();
    refused_calls();
    in_range();
    puts("sizes: good");
    return 0;
}
