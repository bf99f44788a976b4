/* changed_blocks.h - blocks of tiles near the differences of two tables, and parts of tables as tables: for results that
   are computed again only there. */
#pragma once
#include "field/field.h"

/* A table before and after an edit, of one size and wrap. */
typedef struct WrFieldChange {
    const WrField *was, *now;
} WrFieldChange;

#define WR_CHANGED_SIDE (4 * WR_TILE) /* texels along a block's side, at most */

/* Marks the tiles within `reach` of a rectangle of texels, which may lie across periodic edges. marked: [tiles_v][tiles_u]
 * from the top, set to 1 there */
void wr_mark_tiles(const WrField *like, const WrFieldRect *texels, int reach, uint8_t *marked);
/* The same for all texels whose bits changed in any of the tables. */
void wr_mark_changes(const WrFieldChange *changes, int change_count, int reach, uint8_t *marked);
/* The blocks, aligned to tiles, with all texels within `reach` of one whose bits changed in any of the tables. They do
 * not overlap. blocks: output, [returned count], the caller frees it; NULL if there are none */
int wr_changed_blocks(const WrFieldChange *changes, int change_count, int reach,
                      WrFieldRect **blocks);

/* A block with a margin on all sides as a table of its own, clamped; on a clamped axis the margin ends at the table's
 * edge. at: output, the texel of the new table where the block begins. The caller owns it. */
WrField *wr_field_crop(const WrField *field, const WrFieldRect *block, int margin, int at[2]);
/* Writes a part of `made` that begins at its texel `at` as the block of the table. Tiles that do not change stay shared. */
void wr_field_put_block(WrField *field, const WrFieldRect *block, const WrField *made,
                        const int at[2]);
