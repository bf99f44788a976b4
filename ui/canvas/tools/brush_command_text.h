/* brush_command_text.h - brush arguments of a command line, shared by stroke, dab, shape and flood. No window needed. */
#pragma once
#include <stdbool.h>

typedef struct WrBrush WrBrush;
typedef struct WrText WrText;

typedef struct WrBrushNames { /* files of a brush, borrowed; NULL or "": none */
    const char *preset;       /* id in the library */
    const char *set;          /* "name=value;...": base values changed from the preset's */
    const char *tip;          /* a path */
} WrBrushNames;

/* Append " radius=16 hardness=0.5 ..." to a command: always radius, hardness, strength and mode; of the rest, values
 * that the mode uses and that differ from `base`, the brush without these arguments: wr_brush_default(), or the
 * preset's. The line then describes `brush` exactly, except for its files, which `names` provides. */
void wr_brush_line(WrText *line, const WrBrush *brush, const WrBrush *base,
                   const WrBrushNames *names);
/* True if the brush uses random numbers, so that each stroke needs a new seed. */
bool wr_brush_chances(const WrBrush *brush);
