/* What the neurons say of pictures drawn here, and that it does not depend on how the frames come. */
#include "check.h"

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
    size_t bytes = lobula_state_size(p, WIDTH, HEIGHT);
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
        motion_has_a_sign(&p);
        stillness_is_rest(&p);
        blocks_are_steps(&p, &bar);
        blocks_are_steps(&p, &noise);
        networks_do_not_meet(&p);
    }
    puts("network: good");
    return 0;
}
