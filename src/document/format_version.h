/* format_version.h - since when programs know what a scene says: what versions of documents go by.
   Layer 5, private to src/document. */
#pragma once

typedef struct WrScene WrScene;

typedef enum WrSceneAge {
    WR_SCENE_OLD,     /* words of the oldest documents, and what their parts tell */
    WR_SCENE_OF_CELL, /* the cell's size, solid textures, tone, relief shadows, displacement */
    WR_SCENE_OF_FACETS /* pictures of roughness and metalness, occlusion, round lamps, hollows, sheets, frames */
} WrSceneAge;

/* The youngest thing in it that is not as programs that do not know it have it. */
WrSceneAge wr_scene_age(const WrScene *scene);
