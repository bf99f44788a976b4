/* normal_frame.h - the axes that the vectors of a normal map stand in. */
#pragma once

/* Which way x and y of a tangent plane's map run (normal_map.h). */
typedef enum WrNormalFrame {
    WR_FRAME_AUTO,     /* mikk on triangles, else gradient */
    WR_FRAME_GRADIENT, /* slopes of heights over a cell of one unit, added to the table's */
    WR_FRAME_MIKK,     /* unit vectors by the rules of MikkTSpace */
    WR_FRAME_LECTURE, /* unit vectors along Pu and Pv; on triangles the mean of those of its solve */
    WR_FRAME_OBJECT,  /* no such: the object's axes */
    WR_FRAME_COUNT
} WrNormalFrame;
/* As in commands: "auto", "gradient", "mikk", "lecture", which are those of the tangent plane; then NULL. */
extern const char *const wr_normal_frame_names[WR_FRAME_COUNT];
