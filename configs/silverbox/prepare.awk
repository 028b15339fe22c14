# The published split of snls80mV.csv, with u interpolated four times denser (windowed sinc, 48 taps): y stays empty between its samples.
# awk -v from=40650 -v to=57033 -f prepare.awk snls80mV.csv > multisine.csv
BEGIN { n = 0; FS = ","; OFS = ","; half = 24; dense = 4; pi = 3.14159265358979; taps() }
FNR > 1 && FNR - 2 >= from && FNR - 2 <= to { t[n] = $1; u[n] = $2; y[n] = $3; n++ }
END {
  print "t_s,u_V,y_V"
  for (i = 0; i < n; i++) {
    printf "%.9f,%.7g,%s\n", t[i], u[i], y[i]
    for (k = 1; k < dense && i + 1 < n; k++) printf "%.9f,%.7g,\n", t[i] + (t[i + 1] - t[i]) * k / dense, between(i, k)
  }
}
function taps(    k, m, x) {
  for (k = 1; k < dense; k++) {
    for (m = 1 - half; m <= half; m++) {
      x = pi * (k / dense - m)
      w[k, m] = sin(x) / x * (0.5 + 0.5 * cos(x / half))
      sum[k] += w[k, m]
    }
  }
}
function between(i, k,    m, q, v) {
  for (m = 1 - half; m <= half; m++) {
    q = i + m < 0 ? 0 : i + m >= n ? n - 1 : i + m
    v += w[k, m] * u[q]
  }
  return v / sum[k]
}
