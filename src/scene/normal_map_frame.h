/* normal_map_frame.h - coordinate frames of normal maps. */
#pragma once

/* Directions of x and y of a tangent-space map (normal_map.h). */
typedef enum WrNormalFrame {
    WR_FRAME_AUTO,     /* mikk on triangles, otherwise gradient */
    WR_FRAME_GRADIENT, /* slopes of heights over a cell of one unit, added to the table's */
    WR_FRAME_MIKK,     /* unit vectors by the rules of MikkTSpace */
    WR_FRAME_LECTURE,  /* unit vectors along Pu and Pv; on triangles the mean of those of its
                         equation */
    WR_FRAME_OBJECT,   /* not tangent space: the object's axes */
    WR_FRAME_COUNT
} WrNormalFrame;
/* As in commands: "auto", "gradient", "mikk", "lecture", the tangent-space ones; then NULL. */
extern const char *const wr_normal_frame_names[WR_FRAME_COUNT];
