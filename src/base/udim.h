/* udim.h - UDIM, numbers of the unit squares of (u,v) in file names: NAME.1002.png, or NAME.<UDIM>.png for all.

   Tile 1001 + i + 10 j is u of i..i+1 and v of j..j+1, with i = 0..9 and j = 0 and above; numbers have four digits. */
#pragma once
#include <stdbool.h>

#define WR_UDIM_FIRST 1001
#define WR_UDIM_LAST 9999
#define WR_UDIM_COUNT (WR_UDIM_LAST - WR_UDIM_FIRST + 1)
#define WR_UDIM_PATTERN "<UDIM>"

typedef struct WrText WrText;

/* Number of the tile in that column and row; 0: beyond UDIM. */
int wr_udim_number(double column, double row);
static inline int wr_udim_column(int number)
{
    return (number - WR_UDIM_FIRST) % 10;
}
static inline int wr_udim_row(int number)
{
    return (number - WR_UDIM_FIRST) / 10;
}
/* Reads a number of four digits; false: another text, or no tile's number. */
bool wr_udim_parse(const char *text, int *number);

/* True if the name has <UDIM> in place of a tile's number. */
bool wr_udim_is_pattern(const char *path);
/* The name with the number in each such place; the caller frees it. */
char *wr_udim_fill(const char *pattern, int number);
/* "a/b_n.png" -> "a/b_n.1002.png"; the caller frees it. */
char *wr_udim_insert(const char *path, int number);

/* Numbers of the tiles whose files are in the folder of a name, in rising order: of a pattern, or of a name with a
 * number before its ending, such as NAME.1002.png; none of another name.
 *
 * own      number of the name itself; 0: a pattern
 * numbers  [most], most up to WR_UDIM_COUNT
 * Returns  how many there are; up to `most` are stored */
int wr_udim_files(const char *path, int *own, int *numbers, int most);
/* "1001, 1002, 1011, ..." */
void wr_udim_list(const int *numbers, int count, WrText *text);
