/* render_cases.h - scenes that together cover all paths through the renderer, for tests of common properties.
   Include after test.h. */
#pragma once
#include "render_scenes.h"

#include "image/image.h"

typedef struct Case {
    const char *surface;
    WrAntialias aa;
    int samples;
    WrSpread spread;
    WrRefine refine;
    bool orthographic, colour;
    double zoom; /* height of the picture in radii of the object; 0: the camera's fit */
} Case;

static const Case cases[] = {
    { "plane", WR_AA_POINT, 1, 0, 0, false, false, 0 },
    { "torus", WR_AA_POINT, 1, 0, 0, false, true, 0 },
    { "bezier", WR_AA_SUPERSAMPLE, 2, 0, 0, true, false, 0 },
    { "torus", WR_AA_SUPERSAMPLE, 3, WR_SPREAD_JITTERED, 0, false, true, 0 },
    { "sphere", WR_AA_SUPERSAMPLE, 5, WR_SPREAD_JITTERED, 0, true, true, 0 },
    { "cube", WR_AA_SUPERSAMPLE, 40, 0, 0, false, false, 0 },
    { "torus", WR_AA_ADAPTIVE, 8, 0, WR_REFINE_CONTRAST, false, false, 0 },
    { "bezier", WR_AA_ADAPTIVE, 4, WR_SPREAD_JITTERED, WR_REFINE_CONTRAST, true, true, 0 },
    { "cube", WR_AA_ADAPTIVE, 8, 0, WR_REFINE_CONTRAST, false, true, 0 },
    { "sphere", WR_AA_ADAPTIVE, 8, 0, WR_REFINE_BOUND, false, false, 0 },
    { "ribbon", WR_AA_ADAPTIVE, 5, 0, WR_REFINE_BOUND, false, false, 0 },
    { "curl", WR_AA_FILTER, 1, 0, 0, false, true, 0 },
    { "cylinder", WR_AA_MOMENTS, 1, 0, 0, false, false, 0 },
    { "plane", WR_AA_ADAPTIVE, 16, WR_SPREAD_JITTERED, WR_REFINE_CONTRAST, true, true, 0.3 },
    { "torus", WR_AA_ADAPTIVE, 4, 0, WR_REFINE_CONTRAST, true, false, 1.5 },
};
enum { CASES = sizeof cases / sizeof *cases };

static inline WrImage *spots(void)
{
    WrImage *image = wr_image_new(13, 7, 3, NULL);
    TestRandom random = { 4 };
    for (int i = 0; i < 13 * 7 * 3; i++) image->data[i] = (float)test_random(&random);
    return image;
}

static inline WrScene *scene_for(const Case *c)
{
    WrScene *scene = scene_of(c->surface);
    scene->dials.aa = c->aa;
    scene->dials.samples = c->samples;
    scene->dials.spread = c->spread;
    scene->dials.refine = c->refine;
    scene->dials.contrast = 0.02;
    scene->camera.orthographic = c->orthographic;
    if (c->zoom > 0) scene->camera.size = c->zoom;
    if (c->colour) scene->colour = spots();
    return scene;
}
