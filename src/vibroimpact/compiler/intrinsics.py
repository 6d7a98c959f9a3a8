"""Functions that numba inserts as machine instructions."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils
from numba.extending import intrinsic

from vibroimpact.compiler import types


def _function_of_address(kind: Any) -> Any:
    """Return an intrinsic function that makes a function value of a kind from an address."""

    @intrinsic  # type: ignore[untyped-decorator]
    def of_address(typing_context: Any, address: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            pointer = builder.inttoptr(arguments[0], cgutils.voidptr_t)
            value = cgutils.create_struct_proxy(kind)(context, builder)
            value.jit_addr = pointer
            value.c_addr = pointer  # not called where there is the other
            return value._getvalue()

        return kind(types.integer), generate

    return of_address


force_of_address = _function_of_address(types.force)
energies_of_address = _function_of_address(types.energies)
levels_of_address = _function_of_address(types.levels)
compressed_of_address = _function_of_address(types.compressed)
slip_after_of_address = _function_of_address(types.slip_after)
friction_of_address = _function_of_address(types.friction)


_LANES = 8  # doubles of a vector; a machine with shorter ones takes several


@intrinsic  # type: ignore[untyped-decorator]
def product_of_rows(
    typing_context: Any,
    room: Any,
    values: Any,
    matrices: Any,
    matrix: Any,
    width: Any,
    columns: Any,
    product: Any,
) -> Any:
    """Write the product of a row of an array with a matrix into another row, as
    `function_values.multiply_row` says.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array, cube = (
            context.make_array(kind)(context, builder, value)
            for kind, value in zip(
                (types.matrix, types.cube), (arguments[0], arguments[2]), strict=True
            )
        )
        row_length = builder.extract_value(array.shape, 1)
        rows, row_of_matrix = (
            builder.extract_value(cube.shape, 1),
            builder.extract_value(cube.shape, 2),
        )
        source = builder.gep(array.data, [builder.mul(arguments[1], row_length)])
        target = builder.gep(array.data, [builder.mul(arguments[6], row_length)])
        first = builder.gep(
            cube.data, [builder.mul(arguments[3], builder.mul(rows, row_of_matrix))]
        )
        double, integer = ir.DoubleType(), ir.IntType(64)
        lanes = ir.VectorType(double, _LANES)
        nothing = ir.Constant(lanes, [0.0] * _LANES)
        sums = [cgutils.alloca_once(builder, lanes) for _ in range(2)]
        blocks, blocks_of_columns = (builder.lshr(number, integer(3)) for number in arguments[4:6])

        def vector_at(pointer: Any) -> Any:
            return builder.bitcast(pointer, lanes.as_pointer())

        with cgutils.for_range(builder, blocks_of_columns, intp=integer) as block:
            column = builder.shl(block.index, integer(3))
            for one in sums:
                builder.store(nothing, one)
            with cgutils.for_range(builder, blocks, intp=integer) as rows_of_eight:
                begin = builder.shl(rows_of_eight.index, integer(3))
                for number in range(_LANES):
                    row = builder.add(begin, integer(number))
                    value = builder.load(builder.gep(source, [row]))
                    alike = builder.insert_element(nothing, value, ir.IntType(32)(0))
                    alike = builder.shuffle_vector(
                        alike,
                        nothing,
                        ir.Constant(ir.VectorType(ir.IntType(32), _LANES), [0] * _LANES),
                    )
                    place = builder.gep(
                        first, [builder.add(builder.mul(row, row_of_matrix), column)]
                    )
                    weights = builder.load(vector_at(place), align=8)
                    one = sums[number % 2]
                    builder.store(
                        builder.fadd(builder.load(one), builder.fmul(alike, weights)), one
                    )
            whole = builder.fadd(builder.load(sums[0]), builder.load(sums[1]))
            builder.store(whole, vector_at(builder.gep(target, [column])), align=8)
        return context.get_dummy_value()

    numbers = (types.integer, types.integer, types.integer, types.integer)
    return types.void(types.matrix, types.integer, types.cube, *numbers), generate
