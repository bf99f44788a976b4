/* test_grain.c - solid textures: pictures against the reference, which has formulas and noise of its own, in single and
   double precision, on surfaces posed at random angles. Where rays are met in closed form every sample agrees; on the
   torus, which is met by a mesh and steps of Newton, up to 0.5 % differ, in single and double precision alike. */
#include "test.h"
#include "test_render_scenes.h"

#include "base/error.h"
#include "base/pool.h"
#include "render/reference.h"
#include "scene/scene.h"

enum { W = 61, H = 47 };

/* The share of samples that are farther from the reference than `enough`, and how many there are. */
static double differ(const WrScene *scene, const WrField *field, double enough, int *shown)
{
    WrError err = { "" };
    WrReference r = { 0 };
    WrPool *pool = wr_pool_new(2);
    const WrReferenceRequest request = { .field = field,
                                         .scene = scene,
                                         .width = W,
                                         .height = H,
                                         .turn_deg = 15,
                                         .first = 1,
                                         .most = 1 };
    if (!wr_reference_render(&request, pool, &r, &err)) fail_msg("%s", err.text);
    wr_pool_free(pool);
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    int off = 0;
    *shown = 0;
    for (int i = 0; i < W * H; i++) {
        if (r.rgba[4 * i + 3] != 1 || shot.frame.rgba[4 * i + 3] != 1) continue;
        double worst = 0;
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(r.rgba[4 * i + c] - (double)shot.frame.rgba[4 * i + c]));
        off += worst > enough, ++*shown;
    }
    put_away(&shot);
    wr_reference_fini(&r);
    return (double)off / *shown;
}

static void pictures_are_the_references(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "sphere", "cylinder", "cube", "torus" };
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_GRAIN_WOOD; kind < WR_GRAIN_KINDS; kind++)
        for (int s = 0; s < 4; s++)
            for (int in_double = 0; in_double < 2; in_double++) {
                WrScene *scene = scene_of(surfaces[s]);
                int shown;
                scene->grain = wr_grains[kind].usual;
                scene->grain.axis = (WrGrainAxis)((kind + s) % WR_GRAIN_AXES);
                scene->grain.rings *= 0.8137, scene->grain.cells *= 1.193;
                scene->height = 0; /* the reference has slopes of its own */
                scene->posed = true;
                scene->rotate_deg = (WrVec3){ 31.7 + 50 * s, 12.9 * kind, -71.3 };
                scene->dials.aa = WR_AA_POINT;
                if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
                const double off = differ(scene, field, in_double ? 1e-5 : 1e-3, &shown);
                if (!(shown > 200 && off <= (s == 3 ? 0.005 : 0)))
                    fail_msg("%s %s %d: %g of %d apart", wr_grains[kind].name, surfaces[s],
                             in_double, off, shown);
                wr_scene_free(scene);
            }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(pictures_are_the_references) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
