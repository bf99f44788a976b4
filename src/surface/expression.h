/* expression.h - parser of user expressions in u and v.

   The result is a program for a stack machine, run with exact first and second derivatives
   (second-order dual numbers), for one sample or many (expression_body.h).

     numbers, u, v, pi;  + - * / ^, parentheses;  sqrt sin cos exp log abs (x),  pow atan2 min max (x, y);
     angles in radians
     ^ binds tighter than the sign and is right-associative: -2^2 = -4, 2^3^2 = 512 */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

#define WR_PROGRAM_OPS 600     /* of the three expressions together */
#define WR_PROGRAM_STACK 24    /* maximum stack depth, besides the results */
#define WR_EXPRESSION_DEPTH 50 /* maximum nesting of parentheses, signs and powers */
#define WR_POWER_WHOLE 32      /* integer powers up to this are multiplied out */

typedef enum WrOpCode {
    WR_OP_CONST,
    WR_OP_U,
    WR_OP_V,
    WR_OP_ADD,
    WR_OP_SUB,
    WR_OP_MUL,
    WR_OP_DIV,
    WR_OP_NEG,
    WR_OP_SQRT,
    WR_OP_SIN,
    WR_OP_COS,
    WR_OP_EXP,
    WR_OP_LOG,
    WR_OP_ABS,
    WR_OP_WHOLE, /* x to the integer power `value` */
    WR_OP_POWER, /* x to the power `value` */
    WR_OP_POW,
    WR_OP_ATAN2,
    WR_OP_MIN,
    WR_OP_MAX,
    WR_OP_COUNT
} WrOpCode;

typedef struct WrOp {
    WrOpCode code;
    int column;   /* in its source text, from 1 */
    double value; /* CONST, WHOLE, POWER */
} WrOp;

/* Consecutive expressions: each leaves one more value on the stack. */
typedef struct WrProgram {
    int count;
    WrOp op[WR_PROGRAM_OPS];
} WrProgram;

/* Appends an expression. Errors: "NAME: column 7: ..."; the program is then invalid. */
bool wr_expression_read(const char *name, const char *text, WrProgram *program, WrError *err);

/* Number of operands that an operation pops. */
int wr_op_operand_count(WrOpCode code);
