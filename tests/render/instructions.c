/* Workload of instructions.sh: frames of pairs of scenes (one that has an effect and skips it, one without it) in two
   sizes; and frames after a dab. Each counted frame is drawn by wr_test_counted, which the counter recognises; each
   call prints a line with its description. */
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SMALL 64
#define LARGE 256
#define SHEET 512 /* side in pixels of the painted picture */

typedef struct Stage {
    WrScene *scene;
    WrField *field;
} Stage;

typedef void (*Change)(Stage *stage);

static WrPool *pool;
static const char *isa;

bool wr_test_counted(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame);
__attribute__((noinline)) bool wr_test_counted(WrRenderer *renderer, const WrFrameRequest *request,
                                               WrFrame *frame)
{
    return wr_renderer_frame(renderer, request, frame, NULL);
}

static WrRenderer *new_renderer(void)
{
    WrRenderer *renderer = wr_renderer_new(pool, isa, NULL);
    if (!renderer) exit(1);
    return renderer;
}

static WrField *waves(int size)
{
    WrField *field = wr_field_new(size, size, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < size; j++)
        for (int i = 0; i < size; i++)
            wr_field_set(field, i, j, (float)sin(0.3 * i) * (float)cos(0.2 * j));
    return field;
}

/* ---- scenes ---- */

static void plain(Stage *stage)
{
    (void)stage;
}

static void bump(Stage *stage)
{
    wr_field_free(stage->field);
    stage->field = waves(64);
}

static void bump_of_no_height(Stage *stage)
{
    bump(stage);
    stage->scene->height = 0;
}

static void bump_that_stands_still(Stage *stage)
{
    bump(stage);
    stage->scene->replicate_u = stage->scene->replicate_v = 0;
}

static void white_picture(Stage *stage)
{
    WrImage *image = wr_image_new(16, 16, 3, NULL);
    for (int i = 0; i < 16 * 16 * 3; i++) image->data[i] = 1;
    stage->scene->colour = image;
}

static void no_highlight(Stage *stage)
{
    stage->scene->material.specular = 0;
}

static void dark_highlight(Stage *stage)
{
    no_highlight(stage);
    stage->scene->material.shininess = 200;
    stage->scene->material.gate = false;
}

static void one_sample(Stage *stage)
{
    stage->scene->dials.aa = WR_AA_SUPERSAMPLE;
    stage->scene->dials.samples = 1;
}

static void filter_of_nothing(Stage *stage)
{
    stage->scene->dials.aa = WR_AA_FILTER;
}

static void filter(Stage *stage)
{
    bump(stage);
    no_highlight(stage);
    filter_of_nothing(stage);
}

static void moments_of_no_highlight(Stage *stage)
{
    filter(stage);
    stage->scene->dials.aa = WR_AA_MOMENTS;
}

static void square(Stage *stage)
{
    bump(stage);
    wr_shape_default(WR_SURFACE_plane, &stage->scene->shape);
}

static void invariant_square(Stage *stage)
{
    square(stage);
    stage->scene->bump = WR_BUMP_INVARIANT;
}

static void exact_square(Stage *stage)
{
    square(stage);
    stage->scene->bump = WR_BUMP_EXACT;
}

static void bytes_of_nothing(Stage *stage)
{
    stage->scene->dials.heights = WR_HEIGHTS_8;
}

static void second_light(Stage *stage)
{
    WrScene *scene = stage->scene;
    WrLight *lights = wr_alloc(2, sizeof *lights);
    lights[0] = lights[1] = scene->lights[0];
    wr_free(scene->lights);
    scene->lights = lights;
    lights[1].strength = 0;
    scene->light_count = 2;
}

static const struct {
    const char *what;
    Change off, unnamed;
} pairs[] = {
    { "bump of height 0", bump_of_no_height, plain },
    { "bump of replication 0", bump_that_stands_still, plain },
    { "a white picture", white_picture, plain },
    { "a highlight of 0", dark_highlight, no_highlight },
    { "one sample of many", one_sample, plain },
    { "a filter of a level table", filter_of_nothing, plain },
    { "moments without highlight", moments_of_no_highlight, filter },
    { "scale invariance on the unit square", invariant_square, square },
    { "the exact normal on a plane", exact_square, square },
    { "a level table of 8 bits", bytes_of_nothing, plain },
    { "a second light of strength 0", second_light, plain },
};

static Stage stage_of(Change change)
{
    Stage stage = { .scene = wr_scene_new(),
                    .field = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL) };
    wr_shape_default((WrSurfaceKind)wr_surface_find("sphere"), &stage.scene->shape);
    stage.scene->height = 0.02;
    change(&stage);
    return stage;
}

static void strike(Stage *stage)
{
    wr_scene_free(stage->scene);
    wr_field_free(stage->field);
}

/* One-time work of the program, not part of any frame. */
static void first(void)
{
    Stage stage = stage_of(bump);
    WrRenderer *renderer = new_renderer();
    WrFrame frame;
    const WrFrameRequest request = {
        .field = stage.field, .scene = stage.scene, .width = SMALL, .height = SMALL
    };
    if (!wr_renderer_frame(renderer, &request, &frame, NULL)) exit(1);
    wr_renderer_free(renderer);
    strike(&stage);
}

/* The first frame: preparations are the same in both sizes. */
static void draw(const char *what, const char *form, Change change, int side)
{
    Stage stage = stage_of(change);
    WrRenderer *renderer = new_renderer();
    WrFrame frame;
    const WrFrameRequest request = {
        .field = stage.field, .scene = stage.scene, .width = side, .height = side
    };
    if (!wr_test_counted(renderer, &request, &frame)) exit(1);
    printf("%s|%s|%d|%lld\n", what, form, side, (long long)frame.shaded);
    wr_renderer_free(renderer);
    strike(&stage);
}

/* A static plane: complete, and after a small dab. */
static void dab(int size)
{
    Stage stage = stage_of(square);
    stage.scene->posed = true;
    wr_field_free(stage.field);
    stage.field = waves(size);
    WrRenderer *renderer = new_renderer();
    WrFrame frame;
    WrFrameRequest request = {
        .field = stage.field, .scene = stage.scene, .width = SHEET, .height = SHEET, .keep = true
    };
    if (!wr_renderer_frame(renderer, &request, &frame, NULL)) exit(1);
    request.turn_deg = 1; /* the table is prepared, the picture is new */
    if (!wr_test_counted(renderer, &request, &frame)) exit(1);
    printf("dab|all|%d|%lld\n", size, (long long)frame.shaded);
    WrField *edited = wr_field_share(stage.field);
    for (int k = 0; k < 9; k++)
        wr_field_set(edited, 9 * size / 16 + k % 3, 9 * size / 16 + k / 3, 1);
    request.field = edited;
    if (!wr_test_counted(renderer, &request, &frame)) exit(1);
    printf("dab|dab|%d|%lld\n", size, (long long)frame.shaded);
    wr_field_free(edited);
    wr_renderer_free(renderer);
    strike(&stage);
}

int main(void)
{
    pool = wr_pool_new(1);
    isa = wr_kernels_get("v3", false, NULL) ? "v3" : "v1";
    first();
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        for (int form = 0; form < 2; form++)
            for (int large = 0; large < 2; large++)
                draw(pairs[i].what, form ? "unnamed" : "off",
                     form ? pairs[i].unnamed : pairs[i].off, large ? LARGE : SMALL);
    dab(256);
    dab(1024);
    wr_pool_free(pool);
    return 0;
}
