#include "resize.h"

#include <math.h>

#define RESIZE_MAGIC 0x7265737au

static size_t aligned(size_t bytes) { return (bytes + LOBULA_ALIGN - 1) / LOBULA_ALIGN * LOBULA_ALIGN; }

static int within(int start, int length, int whole) { return start >= 0 && length > 0 && start <= whole - length; }

static int resize_layout(resize_plan *r, const lobula_resize_spec *s) {
    if (s->source_width < 1 || s->source_height < 1 || s->out_width < 1 || s->out_height < 1 ||
        s->source_width > LOBULA_MAX_SIDE || s->source_height > LOBULA_MAX_SIDE || s->out_width > LOBULA_MAX_SIDE ||
        s->out_height > LOBULA_MAX_SIDE || !within(s->crop_x, s->crop_width, s->source_width) ||
        !within(s->crop_y, s->crop_height, s->source_height))
        return LOBULA_BAD_ARGUMENT;
    r->spec = *s;
    r->rows_at = aligned(sizeof *r);
    r->columns_at = r->rows_at + aligned((size_t)s->out_height * sizeof(span));
    r->sums_at = r->columns_at + aligned((size_t)s->out_width * sizeof(span));
    r->whole_at = r->sums_at + aligned((size_t)s->crop_width * sizeof(float));
    r->bytes = r->whole_at + aligned((size_t)s->crop_width * sizeof(uint16_t));
    return LOBULA_OK;
}

static void plan_spans(span *spans, int n_in, int n_out) {
    for (int i = 0; i < n_out; i++) {
        double low = (double)n_in * i / n_out, high = (double)n_in * (i + 1) / n_out;
        int first = (int)floor(low), last = (int)ceil(high) - 1;
        if (last > n_in - 1) last = n_in - 1;
        span one = {first, last, (float)(first + 1 - low), (float)(high - last)};
        if (last <= first) {
            one.last = first;
            one.first_share = (float)(high - low);
            one.last_share = 0.0f;
        }
        spans[i] = one;
    }
}

size_t lobula_resize_size(const lobula_resize_spec *spec) {
    resize_plan r;
    return spec && resize_layout(&r, spec) == LOBULA_OK ? r.bytes : 0;
}

int lobula_resize_init(void *plan, const lobula_resize_spec *spec, int isa) {
    resize_plan *r = plan;
    if (!plan || !spec) return LOBULA_BAD_ARGUMENT;
    if (isa == LOBULA_ISA_AUTO) isa = lobula_isa_best();
    if (!lobula_isa_runs(isa) || resize_layout(r, spec) != LOBULA_OK) return LOBULA_BAD_ARGUMENT;
    r->magic = RESIZE_MAGIC;
    r->isa = isa;
    plan_spans((span *)(void *)((char *)plan + r->rows_at), spec->crop_height, spec->out_height);
    plan_spans((span *)(void *)((char *)plan + r->columns_at), spec->crop_width, spec->out_width);
    return LOBULA_OK;
}

int lobula_resize(void *plan, const lobula_images *source, float *out) {
    resize_plan *r = plan;
    if (!plan || !source || !source->pixels || !out) return LOBULA_BAD_ARGUMENT;
    if (source->type != LOBULA_UINT8 && source->type != LOBULA_FLOAT32) return LOBULA_BAD_ARGUMENT;
    if (r->magic != RESIZE_MAGIC) return LOBULA_BAD_STATE;
    size_t pixel = source->type == LOBULA_UINT8 ? 1 : sizeof(float);
    picture crop = {(const char *)source->pixels + (ptrdiff_t)r->spec.crop_y * source->row_bytes +
                        (ptrdiff_t)((size_t)r->spec.crop_x * pixel),
                    source->row_bytes, source->type};
    kernels_of(r->isa, LOBULA_FLOAT)->area_average(r, crop, out);
    return LOBULA_OK;
}
