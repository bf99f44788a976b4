/* bench_materials.h - scene parts of the benchmark for reflection effects and solid textures. */
#pragma once

typedef struct WrScene WrScene;

void wr_bench_facets(WrScene *scene);
void wr_bench_under_sky(WrScene *scene);
void wr_bench_metal(WrScene *scene);
void wr_bench_faint(WrScene *scene);
void wr_bench_wooden(WrScene *scene);
void wr_bench_wooden_filtered(WrScene *scene);
void wr_bench_rough(WrScene *scene);
void wr_bench_objects_hide(WrScene *scene);
void wr_bench_displaced(WrScene *scene);
void wr_bench_parallax(WrScene *scene);
void wr_bench_worn(WrScene *scene);
void wr_bench_embossed(WrScene *scene);
/* Add two smaller objects of the same kind, in front of and behind the sides of the first. */
void wr_bench_three_objects(WrScene *scene);
/* The three objects with shadows on one another. */
void wr_bench_three_shadowed(WrScene *scene);
/* Add a normal map of waves with slopes up to 0.3. */
void wr_bench_mapped(WrScene *scene);
