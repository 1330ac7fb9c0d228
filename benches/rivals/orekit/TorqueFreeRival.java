import java.io.BufferedReader;
import java.io.InputStreamReader;
import java.lang.management.ManagementFactory;
import java.util.Arrays;

import org.hipparchus.geometry.euclidean.threed.Rotation;
import org.hipparchus.geometry.euclidean.threed.Vector3D;
import org.orekit.attitudes.Attitude;
import org.orekit.attitudes.Inertia;
import org.orekit.attitudes.InertiaAxis;
import org.orekit.attitudes.TorqueFree;
import org.orekit.frames.Frame;
import org.orekit.frames.FramesFactory;
import org.orekit.time.AbsoluteDate;

/**
 * Orekit's TorqueFree, as benches/rivals/propagation.py measures it: a process that is asked for runs.
 *
 * The first line of the input is the scene: three moments, a unit quaternion, three rates, number of times, the times, indices. Each further line
 * asks for a run and is answered by a line of JSON: CPU seconds of the thread for all times, those of the constructor, and the rows
 * [x, y, z, w, ω1, ω2, ω3] at the indices. Dates are made beforehand.
 */
public class TorqueFreeRival {

    private static final int WARM_UP = 3;

    public static void main(String[] arguments) throws Exception {
        BufferedReader input = new BufferedReader(new InputStreamReader(System.in));
        double[] scene = Arrays.stream(input.readLine().trim().split("\\s+")).mapToDouble(Double::parseDouble).toArray();
        int count = (int) scene[10];
        AbsoluteDate epoch = AbsoluteDate.ARBITRARY_EPOCH;
        AbsoluteDate[] dates = new AbsoluteDate[count];
        for (int i = 0; i < count; i++) {
            dates[i] = epoch.shiftedBy(scene[11 + i]);
        }
        int[] indices = Arrays.stream(scene, 11 + count, scene.length).mapToInt(x -> (int) x).toArray();
        for (int i = 0; i < WARM_UP; i++) {
            run(scene, dates, indices);
        }
        while (input.readLine() != null) {
            System.out.println(run(scene, dates, indices));
        }
    }

    private static String run(double[] scene, AbsoluteDate[] dates, int[] indices) {
        Frame frame = FramesFactory.getGCRF();
        long start = cpu();
        Inertia inertia = new Inertia(new InertiaAxis(scene[0], Vector3D.PLUS_I), new InertiaAxis(scene[1], Vector3D.PLUS_J),
                                      new InertiaAxis(scene[2], Vector3D.PLUS_K));
        // Applying a rotation of Hipparchus is q̄ v q: of the quaternion from body to inertial components it leads to body components.
        Rotation rotation = new Rotation(scene[6], scene[3], scene[4], scene[5], true);
        Vector3D spin = new Vector3D(scene[7], scene[8], scene[9]);
        TorqueFree motion = new TorqueFree(new Attitude(AbsoluteDate.ARBITRARY_EPOCH, frame, rotation, spin, Vector3D.ZERO), inertia);
        long solved = cpu();
        double[][] rows = new double[dates.length][];
        for (int i = 0; i < dates.length; i++) {
            Attitude attitude = motion.getAttitude(null, dates[i], frame);
            Rotation q = attitude.getRotation();
            Vector3D w = attitude.getSpin();
            rows[i] = new double[] {q.getQ1(), q.getQ2(), q.getQ3(), q.getQ0(), w.getX(), w.getY(), w.getZ()};
        }
        long end = cpu();
        double[][] wanted = Arrays.stream(indices).mapToObj(i -> rows[i]).toArray(double[][]::new);
        return "{\"seconds\": " + 1e-9 * (end - start) + ", \"set_up\": " + 1e-9 * (solved - start) + ", \"rows\": " + Arrays.deepToString(wanted) + "}";
    }

    private static long cpu() {
        return ManagementFactory.getThreadMXBean().getCurrentThreadCpuTime();
    }
}
