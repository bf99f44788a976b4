/* enum_rows.h - tables with a row for each word of an enumeration, which the compiler counts. Layer 0.

       WR_ROWS(wr_blends);
       const WrBlendMode wr_blends[WR_BLEND_COUNT] = {
           [WR_ROW(WR_BLEND_ADD)] = { ... },
           ...
       };
       WR_ROWS_END(wr_blends, WR_BLEND_COUNT);

   A length tells neither of a word in the middle that has no row, nor of the last one where the table is as
   long as it was told to be: both are zeros, and what is called through them stops the program. Here rows
   are counted: none is outside the table, none stands twice, so where there are as many as words, each has
   its own. Several tables within one initialiser are counted together.

   What chooses by such a word instead of keeping a table is a switch without a default, which must name each
   (-Wswitch). Lists without numbers of their own are counted by WR_LENGTH. */
#pragma once

#pragma GCC diagnostic error "-Woverride-init"

#define WR_ROWS(table) enum { table##_rows_ = __COUNTER__ + 1 }
#define WR_ROW(index) ((index) + 0 * __COUNTER__)
#define WR_ROWS_END(table, count)                                                                  \
    _Static_assert(__COUNTER__ - table##_rows_ == (count), #table ": not a row for each")

/* The words of an enumeration that has nothing beside them, in one list with its enumerators:

       #define BONDS(X) X(RUNNING, "running") X(STACK, "stack")
       typedef enum Bond { BONDS(WR_WORD_ID) } Bond;
       static const char *const bonds[] = { BONDS(WR_WORD) NULL }; */
#define WR_WORD_ID(id, word) id,
#define WR_WORD(id, word) word,

/* How many elements an array has. */
#define WR_LENGTH(array) ((int)(sizeof(array) / sizeof *(array)))
