"""Functions that numba inserts as machine instructions."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils
from numba.extending import intrinsic

from vibroimpact.compiler import types
from vibroimpact.compiler.function_values import multiply_row


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

        return kind(types.address), generate

    return of_address


force_of_address = _function_of_address(types.force)
energies_of_address = _function_of_address(types.energies)
levels_of_address = _function_of_address(types.levels)
compressed_of_address = _function_of_address(types.compressed)
slip_after_of_address = _function_of_address(types.slip_after)
friction_of_address = _function_of_address(types.friction)


_MULTIPLICATION = types.signature_of(multiply_row)

_LANES = 8  # doubles of a vector; a machine with shorter ones takes several
_SHIFT = 3  # bits by which an integer is shifted to multiply or divide it by this


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
    """Write the product of a row of an array with a matrix into another row, as `multiply_row`.

    For each eight columns the rows of the matrix are added, each times an element of the row.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        room, values, matrices, matrix, width, columns, product = arguments
        rows = context.make_array(signature.args[0])(context, builder, room)
        cube = context.make_array(signature.args[2])(context, builder, matrices)
        factors = _pointer_to_row(builder, rows, values)
        target = _pointer_to_row(builder, rows, product)
        weights = _pointer_to_matrix(builder, cube, matrix)
        row_of_weights = builder.extract_value(cube.shape, 2)
        integer = ir.IntType(64)
        lanes = ir.VectorType(ir.DoubleType(), _LANES)
        # two sums, so that an addition need not wait for the last one
        sums = [cgutils.alloca_once(builder, lanes) for _ in range(2)]
        row_blocks = builder.lshr(width, integer(_SHIFT))
        column_blocks = builder.lshr(columns, integer(_SHIFT))
        with cgutils.for_range(builder, column_blocks, intp=integer) as column_block:
            column = builder.shl(column_block.index, integer(_SHIFT))
            for partial_sum in sums:
                builder.store(_zeros(), partial_sum)
            with cgutils.for_range(builder, row_blocks, intp=integer) as row_block:
                first_row = builder.shl(row_block.index, integer(_SHIFT))
                for number in range(_LANES):
                    row = builder.add(first_row, integer(number))
                    factor = builder.load(builder.gep(factors, [row]))
                    position = builder.add(builder.mul(row, row_of_weights), column)
                    vector = builder.load(_pointer_to_vector(builder, weights, position), align=8)
                    term = builder.fmul(_vector_of(builder, factor), vector)
                    partial_sum = sums[number % 2]
                    builder.store(builder.fadd(builder.load(partial_sum), term), partial_sum)
            total = builder.fadd(builder.load(sums[0]), builder.load(sums[1]))
            builder.store(total, _pointer_to_vector(builder, target, column), align=8)
        return context.get_dummy_value()

    return _MULTIPLICATION, generate


def _pointer_to_row(builder: Any, array: Any, row: Any) -> Any:
    row_length = builder.extract_value(array.shape, 1)
    return builder.gep(array.data, [builder.mul(row, row_length)])


def _pointer_to_matrix(builder: Any, cube: Any, matrix: Any) -> Any:
    rows = builder.extract_value(cube.shape, 1)
    columns = builder.extract_value(cube.shape, 2)
    return builder.gep(cube.data, [builder.mul(matrix, builder.mul(rows, columns))])


def _pointer_to_vector(builder: Any, pointer: Any, position: Any) -> Any:
    """Return the pointer to the doubles from a position on, as a vector."""
    vector = ir.VectorType(ir.DoubleType(), _LANES)
    return builder.bitcast(builder.gep(pointer, [position]), vector.as_pointer())


def _vector_of(builder: Any, value: Any) -> Any:
    """Return a vector whose elements are all one value."""
    index = ir.IntType(32)
    first = builder.insert_element(_zeros(), value, index(0))
    mask = ir.Constant(ir.VectorType(index, _LANES), [0] * _LANES)
    return builder.shuffle_vector(first, _zeros(), mask)


def _zeros() -> Any:
    return ir.Constant(ir.VectorType(ir.DoubleType(), _LANES), [0.0] * _LANES)
