$ SUPERELEMENT 100: INCLUDE IN THE MAIN BULK DATA. AT THE TOP OF THE DECK:
$ ASSIGN INPUTT4='NAME.op4',UNIT=100,FORM=FORMATTED
$
SEBULK       100  EXTOP4          MANUAL                     100
SECONCT      100       0              NO
               7       7       8       8
$
$ ATTACHMENT NODES
$
GRID*                  7               0 0.000000000E+00 0.000000000E+00
*       -2.000000000E-03               0           12456
GRID*                  8               0 1.000000000E+00-2.500000000E-01
*        3.333333333E-01               0            1246
$
$ FIXED-INTERFACE MODES
$
SPOINT         9    THRU      10
SECONCT      100       0              NO
               9       9      10      10
