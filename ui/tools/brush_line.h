/* brush_line.h - a brush as the arguments of a command line: what stroke, dab, shape and flood share. No
   window needed. */
#pragma once
#include <stdbool.h>

typedef struct WrBrush WrBrush;
typedef struct WrText WrText;

typedef struct WrBrushNames { /* of the files that a brush comes from, borrowed; NULL or "": none */
    const char *preset;       /* id in the library */
    const char *set;          /* "name=value;...": base values other than the preset's */
    const char *tip;          /* a path */
} WrBrushNames;

/* Add " radius=16 hardness=0.5 ..." to a command: radius, hardness, strength and mode always, of the rest
 * what the mode goes by and what differs from `base`, which is the brush that the line means without them:
 * wr_brush_default(), or that of the preset. The line then means `brush` again, but for the files, which
 * are those that `names` names. */
void wr_brush_line(WrText *line, const WrBrush *brush, const WrBrush *base,
                   const WrBrushNames *names);
/* Is anything in it random? Then each stroke wants a seed of its own. */
bool wr_brush_chances(const WrBrush *brush);
