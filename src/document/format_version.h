/* format_version.h - oldest file version that can hold a scene.
   Private to src/document. */
#pragma once

typedef struct WrScene WrScene;

typedef enum WrSceneAge {
    WR_SCENE_OLD,     /* commands of the oldest documents, and features that have their own parts */
    WR_SCENE_OF_CELL, /* the cell's size, solid textures, tone, relief shadows, displacement */
    /* roughness and metalness pictures, occlusion, area lamps, hollows, sheets, frames */
    WR_SCENE_OF_FACETS
} WrSceneAge;

/* The newest feature in the scene that differs from its default in older programs. */
WrSceneAge wr_scene_age(const WrScene *scene);
