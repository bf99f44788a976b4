/* bench_materials.h - what scenes of the bench are made of, for the effects of reflection and of solid textures.
   Layer 7. */
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
/* Two more like it, smaller, before and behind its sides. */
void wr_bench_three(WrScene *scene);
/* The same, and they throw shadows on one another. */
void wr_bench_three_hide(WrScene *scene);
/* A normal map of waves, of slopes up to 0.3. */
void wr_bench_mapped(WrScene *scene);
