package lensprof.examples;

import com.sun.jna.Structure;
import lensprof.Abi;

/** Prints sizes and offsets of structures, as tests/python/abi_dump.c does; tests/bindings compares the two. */
public final class AbiDump {
    private AbiDump() {
    }

    public static void main(String[] arguments) throws ReflectiveOperationException {
        for (Class<?> type : Abi.class.getDeclaredClasses()) {
            Abi.StructName name = type.getAnnotation(Abi.StructName.class);
            if (name != null) {
                Abi.Struct struct = (Abi.Struct) type.getDeclaredConstructor().newInstance();
                System.out.println("struct " + name.value() + ' ' + struct.size() + ' ' + struct.alignment());
                for (String field : type.getAnnotation(Structure.FieldOrder.class).value()) {
                    System.out.println("field " + name.value() + ' ' + field + ' ' + struct.offset(field));
                }
            }
        }
    }
}
