/* What the neurons say of pictures drawn here, and that it does not depend on how the frames come. */
#include "check.h"

#include <math.h>

enum { WIDTH = 99, HEIGHT = 72, FRAMES = 24 };

typedef uint8_t film[FRAMES][HEIGHT][WIDTH];

static film bar, mirrored, noise;
static double times_s[FRAMES];

/* A dark bar, 6 px wide and full of texture, goes right 2 px a frame; and the same seen in a mirror. */
static void draw(void) {
    uint32_t draw = 1;
    for (int t = 0; t < FRAMES; t++) {
        times_s[t] = t / 30.0;
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                int within = x - (20 + 2 * t);
                uint8_t grey = within >= 0 && within < 6 ? (uint8_t)(40 + 7 * within + 3 * (y % 5)) : 180;
                bar[t][y][x] = mirrored[t][y][WIDTH - 1 - x] = grey;
                draw = draw * 1664525u + 1013904223u;
                noise[t][y][x] = (uint8_t)(draw >> 24);
            }
    }
}

static void step_through(const lobula_net *net, film *pictures, lobula_reading *readings) {
    for (int t = 0; t < FRAMES; t++) {
        lobula_images image = bytes_of((*pictures)[t][0], WIDTH, HEIGHT);
        CHECK(lobula_step(net, &image, times_s[t], 0, &readings[t], NULL) == LOBULA_OK, "a step");
    }
}

static void same(const lobula_reading *a, const lobula_reading *b, const char *what) {
    CHECK(memcmp(a, b, FRAMES * sizeof *a) == 0, what);
}

static void motion_has_a_sign(const lobula_params *p) {
    lobula_reading right[FRAMES], left[FRAMES];
    lobula_net net = network(p, WIDTH, HEIGHT, 1);
    step_through(&net, &bar, right);
    CHECK(lobula_reset(net.state) == LOBULA_OK, "a reset");
    step_through(&net, &mirrored, left);
    for (int t = 3; t < FRAMES; t++) {
        CHECK(right[t].lptc_r > 0.0 && right[t].lptc_l == 0.0, "a bar that goes right");
        CHECK(left[t].lptc_l < 0.0 && left[t].lptc_r == 0.0, "a bar that goes left");
        double difference = right[t].lptc_r + left[t].lptc_l;
        CHECK(difference < 1e-6 && difference > -1e-6, "a mirror changes the sign and nothing else");
    }
    release(&net);
}

static void stillness_is_rest(const lobula_params *p) {
    static film plain;
    lobula_reading readings[FRAMES];
    for (int grey = 0; grey <= 255; grey += 85) {
        memset(plain, grey, sizeof plain);
        lobula_net net = network(p, WIDTH, HEIGHT, 1);
        step_through(&net, &plain, readings);
        for (int t = 0; t < FRAMES; t++) {
            const lobula_reading *r = &readings[t];
            CHECK(r->lgmd1 == 0.5 && r->lgmd2 == 0.5 && r->lptc_r == 0.0 && r->lptc_l == 0.0, "a constant picture");
            CHECK(!r->spikes[0] && !r->spikes[1] && !r->spikes[2] && !r->spikes[3] && !r->collision, "is silent");
        }
        release(&net);
    }
}

/* What LGMD-2 says when a square of `side` px, its upper left corner at (row, column), changes on a grey of 100. */
static double said_to_a_square(const lobula_params *p, int row, int column, int side, int change) {
    static uint8_t pictures[2][HEIGHT][WIDTH];
    lobula_net net = network(p, WIDTH, HEIGHT, 1);
    lobula_reading reading;
    memset(pictures, 100, sizeof pictures);
    for (int y = row; y < row + side; y++)
        for (int x = column; x < column + side; x++) pictures[1][y][x] = (uint8_t)(100 + change);
    for (int t = 0; t < 2; t++) {
        lobula_images image = bytes_of(pictures[t][0], WIDTH, HEIGHT);
        CHECK(lobula_step(&net, &image, times_s[t], 0, &reading, NULL) == LOBULA_OK, "a step");
    }
    release(&net);
    return reading.lgmd2;
}

static int about(double potential, double sum) { return fabs(potential - 1.0 / (1.0 + exp(-sum))) < 1e-6; }

/* LGMD-2 with nothing but patches of 9 px and a floor of 2, of which 11 x 8 fill the picture of 7128 px.
 *
 * A square of 18 px that darkens by 10 fills four: OFF = 4 x 81 x (10 - 2) = 2592, and 11 x 2592 / 7128 = 4.
 * Three columns further it lies on six, in two rows, with means of 20/3, 10 and 10/3: OFF = 2 x 81 x 14 = 2268, which
 * makes 3.5. What is heard is the whole change, however little of it goes on. */
static void what_darkens_is_heard_in_patches(void) {
    lobula_params p = published();
    p.saturation.enabled = 1;
    p.saturation.limit_grey = 1;
    p.coarse.floor_grey = 2.0;
    p.lgmd2.on_gain = p.lgmd2.off_gain = p.lgmd2.product_gain = 0.0;
    p.lgmd2.coarse_gain = 11.0;
    p.lgmd2.sfa.enabled = 0;
    CHECK(about(said_to_a_square(&p, 27, 45, 18, -10), 4.0), "four patches darken");
    CHECK(about(said_to_a_square(&p, 27, 48, 18, -10), 3.5), "six patches darken, some of them in part");
    CHECK(said_to_a_square(&p, 27, 45, 18, 10) == 0.5, "four patches brighten");
    CHECK(said_to_a_square(&p, 27, 45, 18, -2) == 0.5, "four patches darken too little");
    CHECK(said_to_a_square(&p, 27, 45, 4, -10) == 0.5, "a mean of 160 / 81 is under the floor");
    p.coarse.patch_px = 10; /* 9 x 7 of them */
    CHECK(said_to_a_square(&p, 20, 90, 9, -90) == 0.5, "nobody hears the columns that are left over");
    p.coarse.patch_px = 73;
    CHECK(said_to_a_square(&p, 0, 0, 72, -90) == 0.5, "nobody hears patches larger than the picture");
}

static void blocks_are_steps(const lobula_params *p, film *pictures) {
    lobula_reading one[FRAMES], many[FRAMES];
    lobula_net net = network(p, WIDTH, HEIGHT, 16);
    lobula_images images = bytes_of((*pictures)[0][0], WIDTH, HEIGHT);
    const int at_once[] = {1, 2, 5, 16};
    step_through(&net, pictures, one);
    for (int i = 0; i < 4; i++) {
        lobula_reset(net.state);
        memset(many, 0xa5, sizeof many);
        CHECK(lobula_run(&net, &images, times_s, NULL, FRAMES, at_once[i], many) == LOBULA_OK, "a block");
        same(one, many, "a block and its frames one by one");
    }
    release(&net);
}

/* Two networks share a workspace and take turns; a third is copied half way. */
static void networks_do_not_meet(const lobula_params *p) {
    lobula_reading alone[2][FRAMES], turns[2][FRAMES], copied;
    film *pictures[2] = {&bar, &noise};
    lobula_net net[2] = {network(p, WIDTH, HEIGHT, 1), network(p, WIDTH, HEIGHT, 1)};
    lobula_net shared = {net[1].state, net[0].workspace};
    size_t bytes = lobula_state_size(p, WIDTH, HEIGHT, LOBULA_FLOAT);
    lobula_net copy = {memory(bytes), net[1].workspace};
    for (int i = 0; i < 2; i++) {
        step_through(&net[i], pictures[i], alone[i]);
        lobula_reset(net[i].state);
    }
    for (int t = 0; t < FRAMES; t++) {
        for (int i = 0; i < 2; i++) {
            lobula_images image = bytes_of((*pictures[i])[t][0], WIDTH, HEIGHT);
            CHECK(lobula_step(i ? &shared : &net[0], &image, times_s[t], 0, &turns[i][t], NULL) == LOBULA_OK, "a step");
            if (i == 0 && t > FRAMES / 2) {
                lobula_step(&copy, &image, times_s[t], 0, &copied, NULL);
                CHECK(memcmp(&copied, &turns[0][t], sizeof copied) == 0, "a copied state goes on alike");
            }
        }
        if (t == FRAMES / 2) memcpy(copy.state, net[0].state, bytes);
    }
    same(alone[0], turns[0], "the first of two networks");
    same(alone[1], turns[1], "the second of two networks");
    free(copy.state);
    release(&net[0]);
    release(&net[1]);
}

int main(void) {
    lobula_params p = published();
    draw();
    for (int reads = 0; reads < 2; reads++) {
        p.lgmd1.reads = p.lgmd2.reads = reads;
        lobula_params patched = p;
        patched.saturation.enabled = 1;
        patched.coarse.patch_px = 7;
        patched.lgmd2.coarse_gain = 0.1;
        motion_has_a_sign(&p);
        stillness_is_rest(&p);
        blocks_are_steps(&p, &bar);
        blocks_are_steps(&p, &noise);
        blocks_are_steps(&patched, &bar);
        blocks_are_steps(&patched, &noise);
        networks_do_not_meet(&p);
    }
    what_darkens_is_heard_in_patches();
    puts("network: good");
    return 0;
}
