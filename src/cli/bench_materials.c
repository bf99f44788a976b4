#include "cli/bench_materials.h"

#include "base/memory.h"
#include "image/image.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

#include <math.h>

void wr_bench_facets(WrScene *scene)
{
    scene->material.model = WR_REFLECT_GGX;
}

/* Environment light in place of the lamp. */
void wr_bench_under_sky(WrScene *scene)
{
    scene->light_count = 0;
    wr_environment_set(&scene->environment, WR_ENVIRONMENT_MAP_SKY,
                       wr_environment_map_built(WR_ENVIRONMENT_MAP_SKY, NULL), NULL, NULL);
}

void wr_bench_metal(WrScene *scene)
{
    wr_bench_facets(scene);
    scene->material.metalness = 1;
}

/* Plastic: most of it shows no highlight. */
void wr_bench_faint(WrScene *scene)
{
    wr_bench_facets(scene);
    scene->material.roughness = 0.2;
    scene->dials.faint = 1e-4;
}

void wr_bench_wooden(WrScene *scene)
{
    scene->grain = wr_grains[WR_SOLID_TEXTURE_WOOD].usual;
}

void wr_bench_wooden_filtered(WrScene *scene)
{
    wr_bench_wooden(scene);
    scene->dials.aa = WR_AA_FILTER;
}

void wr_bench_rough(WrScene *scene)
{
    wr_bench_facets(scene);
    wr_bench_wooden(scene);
    scene->grain.drives = WR_SOLID_TEXTURE_ROUGHENS;
}

/* Roughness and metalness maps with waves. */
void wr_bench_worn(WrScene *scene)
{
    wr_bench_facets(scene);
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        WrImage *image = wr_image_new(256, 256, 1, NULL);
        for (int i = 0; i < 256 * 256 && image; i++) {
            const int phase = k ? i / 256 : i % 256;
            image->data[i] = (float)(0.4 + 0.3 * sin(phase * 0.39269908169872414));
        }
        scene->facets[k].image = image;
    }
}

void wr_bench_embossed(WrScene *scene)
{
    wr_bench_wooden(scene);
    scene->grain.drives = WR_SOLID_TEXTURE_BUMPS;
}

void wr_bench_objects_hide(WrScene *scene)
{
    scene->lights[0].shadow = true;
}

void wr_bench_displaced(WrScene *scene)
{
    scene->displaced = true;
}

void wr_bench_parallax(WrScene *scene)
{
    scene->parallax = true;
}

void wr_bench_three_objects(WrScene *scene)
{
    WrScene **others = wr_alloc(2, sizeof *others);
    for (int i = 0; i < 2; i++) {
        others[i] = wr_scene_clone(scene);
        others[i]->at = (WrVec3){ i ? 0.7 : -0.7, 0.2, i ? 0.4 : -0.4 };
        others[i]->size = 0.5;
    }
    scene->others = others;
    scene->other_count = 2;
}

void wr_bench_three_shadowed(WrScene *scene)
{
    wr_bench_three_objects(scene);
    scene->lights[0].shadow = true;
}

void wr_bench_mapped(WrScene *scene)
{
    WrNormalMap *map = &scene->normals;
    map->image = wr_image_new(256, 256, 3, NULL);
    map->strength = 1;
    for (int i = 0; i < 256 * 256 && map->image; i++) {
        /* Slope 0.3 sin(2 pi 16 u): 16 waves over 256 texels; (x, 0, 1) normalised. */
        const double x = 0.3 * sin(i % 256 * 0.39269908169872414), z = 1 / sqrt(1 + x * x);
        map->image->data[3 * i] = (float)(x * z);
        map->image->data[3 * i + 2] = (float)z;
    }
}
