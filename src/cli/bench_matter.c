#include "cli/bench_matter.h"

#include "scene/scene.h"

void wr_bench_of_facets(WrScene *scene)
{
    scene->material.model = WR_REFLECT_GGX;
}

void wr_bench_wooden(WrScene *scene)
{
    scene->grain = wr_grains[WR_GRAIN_WOOD].usual;
}

void wr_bench_wooden_filtered(WrScene *scene)
{
    wr_bench_wooden(scene);
    scene->dials.aa = WR_AA_FILTER;
}

void wr_bench_roughened(WrScene *scene)
{
    wr_bench_of_facets(scene);
    wr_bench_wooden(scene);
    scene->grain.drives = WR_GRAIN_ROUGHENS;
}

void wr_bench_embossed(WrScene *scene)
{
    wr_bench_wooden(scene);
    scene->grain.drives = WR_GRAIN_BUMPS;
}

void wr_bench_objects_hide(WrScene *scene)
{
    scene->lights[0].shadow = true;
}
