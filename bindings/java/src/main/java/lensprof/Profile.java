package lensprof;

import com.sun.jna.Memory;
import com.sun.jna.Pointer;

/** Response and falloff of one camera, lens and setting: 50 kB. */
public final class Profile {
    final Abi.Profile raw = new Abi.Profile().init(Lensprof.LIBRARY);

    Profile() {
        raw.setAutoSynch(false); // the memory is the profile; members are read when they are asked for
    }

    /** The profile of a blob. */
    public static Profile unpack(byte[] blob) {
        Profile profile = new Profile();
        int status = Lensprof.LIBRARY.lensprof_profile_unpack(memory(blob), new Abi.Size(blob.length), profile.raw);
        LensprofException.checkBlob(status, blob.length, "the blob cannot be unpacked");
        return profile;
    }

    /** The profile as a blob, without covariance. */
    public byte[] pack() {
        int bytes = pack(Pointer.NULL, 0);
        Memory blob = new Memory(bytes);
        pack(blob, bytes);
        return blob.getByteArray(0, bytes);
    }

    private int pack(Pointer data, int capacity) {
        Memory count = new Memory(Long.BYTES);
        count.clear();
        int status = Lensprof.LIBRARY.lensprof_profile_pack(raw, 0, data, new Abi.Size(capacity), count);
        LensprofException.check(status, "this profile: has values out of range; make it again");
        return (int) count.getLong(0);
    }

    public Key key() {
        raw.readField("key");
        return Key.ofRaw(raw.key);
    }

    /** Relative illuminance of green in the corner, or of all channels. */
    public double cornerFalloff() {
        return Lensprof.LIBRARY.lensprof_profile_radial_falloff(raw, 1, 1.0, Pointer.NULL);
    }

    /** Bytes in memory of C; NULL if there are none. */
    static Pointer memory(byte[] bytes) {
        if (bytes.length == 0) {
            return Pointer.NULL;
        }
        Memory memory = new Memory(bytes.length);
        memory.write(0, bytes, 0, bytes.length);
        return memory;
    }
}
