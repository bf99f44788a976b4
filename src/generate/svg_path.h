/* svg_path.h - SVG path data as points that can be moved, and its outline. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* A command with absolute numbers: M x,y  L x,y  C x1,y1 x2,y2 x,y  Q x1,y1 x,y  A rx,ry turn large sweep x,y  Z. */
typedef struct WrSvgPiece {
    char letter;
    double n[7];
} WrSvgPiece;

/* Zeroed is empty. */
typedef struct WrSvgPath {
    WR_ARRAY(WrSvgPiece) pieces;
} WrSvgPath;

/* A point: the end of a piece, or a handle of its curve. */
typedef struct WrSvgPoint {
    int piece, number; /* its x is pieces.data[piece].n[number], its y the next number */
    bool handle;
    double x, y;
    double of[2]; /* of a handle: the end of a piece that it belongs to */
} WrSvgPoint;

/* H, V, S, T and relative commands become absolute L, C, Q. False: malformed, or without a point. */
bool wr_svg_path_parse(const char *text, WrSvgPath *out);
void wr_svg_path_fini(WrSvgPath *path);
/* digits after the point, 0..9 */
void wr_svg_path_print(const WrSvgPath *path, int digits, WrText *text);

/* Number of points; the first `room` of them are stored. */
int wr_svg_path_points(const WrSvgPath *path, WrSvgPoint *points, int room);
/* Move a point; the handles at the end of a piece move with it. */
void wr_svg_path_move(WrSvgPath *path, const WrSvgPoint *point, double x, double y);
/* Divide the piece nearest to a place by a point on it; a curve keeps its form. False: there is none. */
bool wr_svg_path_divide(WrSvgPath *path, double x, double y);
/* Remove the end of a piece, or the curvature of a handle's piece. False: too few would remain. */
bool wr_svg_path_remove(WrSvgPath *path, const WrSvgPoint *point);

/* The outline as polylines: x,y pairs, and the index of the first pair of each subpath; subpaths are closed. */
typedef struct WrSvgOutline {
    WR_ARRAY(double) xy;
    WR_ARRAY(int) first;
} WrSvgOutline;
void wr_svg_path_outline(const WrSvgPath *path, WrSvgOutline *out);
void wr_svg_outline_fini(WrSvgOutline *outline);
/* x, y, width, height of the bounding box of the filled path. */
void wr_svg_outline_box(const WrSvgOutline *outline, double box[4]);
