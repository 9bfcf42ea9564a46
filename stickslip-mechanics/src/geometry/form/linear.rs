//! Small systems of linear equations.

/// Gauss-Jordan elimination with pivots: unknown `i` in column `i` of each row, the right side in the last. `None`
/// where a pivot is less than `least`.
pub fn solve<const N: usize>(rows: &mut [[f64; N]], least: f64) -> Option<Vec<f64>> {
    for i in 0..rows.len() {
        let pivot = (i..rows.len()).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs()))?;
        rows.swap(i, pivot);
        let of = rows[i];
        if of[i].is_nan() || of[i].abs() < least {
            return None;
        }
        for row in rows.iter_mut().enumerate().filter(|(j, _)| *j != i).map(|(_, row)| row) {
            let factor = row[i] / of[i];
            row.iter_mut().zip(of).for_each(|(entry, of)| *entry -= factor * of);
        }
    }
    Some(rows.iter().enumerate().map(|(i, row)| row[N - 1] / row[i]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_solved_whatever_their_order_and_no_sooner_than_they_can_be() {
        let mut rows = [[0.0, 2.0, 4.0], [3.0, 1.0, 5.0]];
        assert_eq!(solve(&mut rows, 1e-9), Some(vec![1.0, 2.0]));
        assert_eq!(solve(&mut [[1.0, 2.0, 0.0], [2.0, 4.0, 1.0]], 1e-9), None);
    }
}
